#include "importers/static_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "asset_build/link_overlap.h"
#include "asset_build/rest_pose.h"
#include "assets/articulated_asset.h"
#include "assets/joint_poses.h"
#include "geometry/convex_cut.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/mass_properties.h"
#include "geometry/weld.h"
#include "importers/link_folding.h"
#include "sim/drop_test.h"

namespace simwright::importers {
namespace {

using assets::UrdfModel;

constexpr double kBaseShare = 0.01;   // of the diagonal
constexpr double kMaxBaseCut = 2e-3;  // m
constexpr double kLevel = 1e-5;       // m: flatness tolerance of a base
constexpr double kFlatShare = 0.9;    // minimum flat area over the base area at kMaxBaseCut
constexpr double kFlat = 1e-6;        // m: vertices this low already lie on the flat face
constexpr double kFalls = 5.0 * std::numbers::pi / 180.0;
constexpr double kTurned = 0.5 * std::numbers::pi / 180.0;

// Returns the model as one body of uniform density.
sim::RigidBody WholeOf(const UrdfModel& model) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  sim::RigidBody body;
  body.name = model.name;
  geometry::MassProperties total;
  for (size_t i = 0; i < model.links.size(); ++i) {
    for (const assets::UrdfShape& shape : model.links[i].collisions) {
      core::TriangleMesh part = shape.mesh;
      core::Transform(Eigen::Affine3d(poses[i]), &part);
      const auto one = geometry::SolidMassProperties(part, 1000.0);
      total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
      body.parts.push_back(std::move(part));
    }
  }
  body.inertial = {total.mass, total.center_of_mass, total.inertia};
  return body;
}

void Turn(const Eigen::Matrix3d& turn, UrdfModel* model) {
  const Eigen::Affine3d map{Eigen::Isometry3d(Eigen::Quaterniond(turn))};
  for (assets::UrdfLink& link : model->links) {
    for (std::vector<assets::UrdfShape>* shapes : {&link.visuals, &link.collisions}) {
      for (assets::UrdfShape& shape : *shapes) {
        core::Transform(map, &shape.mesh);
        shape.link_from_file = map * shape.link_from_file;
      }
    }
    if (!link.inertial) continue;
    link.inertial->center_of_mass = turn * link.inertial->center_of_mass;
    link.inertial->inertia = (turn * link.inertial->inertia * turn.transpose()).eval();
  }
  for (assets::Joint& joint : model->joints) {
    joint.axis = (turn * joint.axis).normalized();
    joint.parent_from_joint.translation() = turn * joint.parent_from_joint.translation();
  }
}

double LowestOfAll(const UrdfModel& model, const std::vector<Eigen::Isometry3d>& poses) {
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < model.links.size(); ++i) {
    lowest = std::min(lowest, asset_build::LowestOf(model.links[i], poses[i]));
  }
  return lowest;
}

// Returns the area of the hull of the root's group below `height`, m^2.
double BaseArea(const UrdfModel& model, const std::vector<Eigen::Isometry3d>& poses,
                double height) {
  const asset_build::LinkGroups groups(model);
  std::vector<Eigen::Vector2d> low;
  for (size_t i = 0; i < model.links.size(); ++i) {
    if (!groups.Rigid(i, 0)) continue;
    for (const assets::UrdfShape& shape : model.links[i].collisions) {
      for (const Eigen::Vector3d& v : shape.mesh.vertices) {
        const Eigen::Vector3d p = poses[i] * v;
        if (p.z() <= height) low.push_back(p.head<2>());
      }
    }
  }
  const std::vector<Eigen::Vector2d> hull = geometry::ConvexHull2d(std::move(low));
  double area = 0.0;
  for (size_t k = 0; k < hull.size(); ++k) {
    const Eigen::Vector2d &a = hull[k], &b = hull[(k + 1) % hull.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return hull.size() < 3 ? 0.0 : area;
}

// Cuts the parts of the root's group at `height`.
void CutBase(const std::vector<Eigen::Isometry3d>& poses, double height, UrdfModel* model) {
  const asset_build::LinkGroups groups(*model);
  for (size_t i = 0; i < model->links.size(); ++i) {
    if (!groups.Rigid(i, 0)) continue;  // wheels stay round
    for (assets::UrdfShape& shape : model->links[i].collisions) {
      const Eigen::Vector3d down = -(poses[i].linear().transpose() * Eigen::Vector3d::UnitZ());
      const double offset = poses[i].translation().z() - height;
      double above = -1.0, below = -1.0;
      for (const Eigen::Vector3d& v : shape.mesh.vertices) {
        const double z = (poses[i] * v).z();
        above = std::max(above, z - height);
        below = std::max(below, height - z);
      }
      // A part that lies entirely below, such as a paper-thin base, is the flat face and keeps its
      // shape.
      if (below <= kFlat || above <= kFlat) continue;
      core::TriangleMesh cut = geometry::CutConvex(shape.mesh, down, offset);
      if (!cut.empty()) shape.mesh = std::move(cut);
    }
  }
}

void SetDown(double by, UrdfModel* model) {
  const Eigen::Affine3d map{Eigen::Translation3d(0.0, 0.0, -by)};
  for (std::vector<assets::UrdfShape>* shapes :
       {&model->links.front().visuals, &model->links.front().collisions}) {
    for (assets::UrdfShape& shape : *shapes) {
      core::Transform(map, &shape.mesh);
      shape.link_from_file = map * shape.link_from_file;
    }
  }
  if (model->links.front().inertial) model->links.front().inertial->center_of_mass.z() -= by;
  for (assets::Joint& joint : model->joints) {
    if (joint.parent == model->links.front().name) joint.parent_from_joint.translation().z() -= by;
  }
}

}  // namespace

core::Findings MakeStaticallyStable(UrdfModel* model) {
  core::Findings findings;
  const double diagonal = BoundsAtZero(*model).diagonal().norm();
  const auto level = [&] {
    const auto poses = assets::LinkPosesAtZero(*model);
    const double lowest = LowestOfAll(*model, poses);
    const double foot = std::min(kBaseShare * diagonal, kMaxBaseCut);
    const double flat = BaseArea(*model, poses, lowest + kLevel);
    // A model that already stands on a flat face is unchanged.
    if (flat <= 0.0 || flat < kFlatShare * BaseArea(*model, poses, lowest + foot)) {
      CutBase(poses, lowest + foot, model);
    }
    SetDown(LowestOfAll(*model, poses), model);
  };
  level();
  const sim::RigidBody whole = WholeOf(*model);
  // A bottle that rocks slightly still stands; only a model that falls is rotated.
  if (sim::DropInBullet(whole).tilt < kFalls) return findings;
  const asset_build::RestPose rest = asset_build::FindRestPose(whole);
  const double tilt = sim::TiltBetween(rest.turn, Eigen::Isometry3d::Identity());
  if (!rest.held) {
    findings.push_back({"rolls", core::Severity::kWarning, model->name,
                        "no pose holds within 5 degrees: it keeps its given pose", 0.0,
                        "place it where something holds it"});
    return findings;
  }
  if (tilt > kTurned) {
    Turn(rest.turn.linear(), model);
    CenterAboveOrigin(1.0, model);
    level();
    findings.push_back(
        {"does-not-stand", core::Severity::kWarning, model->name,
         "it falls over in its given pose: " + asset_build::RestSentence(rest.turn, false),
         tilt * 180.0 / std::numbers::pi, "fix its root if it is mounted"});
  }
  return findings;
}

TippingMargin LeastTippingMargin(const UrdfModel& model) {
  constexpr int kSteps = 24;
  constexpr double kTouches = 1e-3;  // m
  const asset_build::LinkGroups groups(model);
  const std::vector<Eigen::Isometry3d> at_zero = assets::LinkPosesAtZero(model);
  const std::vector<bool> bears = asset_build::SupportingLinks(model);
  std::vector<Eigen::Vector2d> touching;
  for (size_t i = 0; i < model.links.size(); ++i) {
    if (!groups.Rigid(i, 0) && !bears[i]) continue;
    for (const assets::UrdfShape& shape : model.links[i].collisions) {
      for (const Eigen::Vector3d& v : shape.mesh.vertices) {
        const Eigen::Vector3d p = at_zero[i] * v;
        if (p.z() < kTouches) touching.push_back(p.head<2>());
      }
    }
  }
  const std::vector<Eigen::Vector2d> support = geometry::ConvexHull2d(std::move(touching));
  TippingMargin least{std::numeric_limits<double>::infinity(), "", 0.0};
  if (support.size() < 3) return least;  // it rests on a point or a line: unknown
  for (const assets::Joint& joint : model.joints) {
    if (!joint.Moves() || joint.type == assets::JointType::kContinuous) continue;
    for (int i = 0; i <= kSteps; ++i) {
      const double position = joint.lower + (joint.upper - joint.lower) * i / kSteps;
      const Eigen::Vector2d center =
          assets::CombinedInertial(model, {{joint.name, position}}).center_of_mass.head<2>();
      double margin = std::numeric_limits<double>::infinity();
      for (size_t k = 0; k < support.size(); ++k) {
        const Eigen::Vector2d side = (support[(k + 1) % support.size()] - support[k]).normalized();
        const Eigen::Vector2d inward(-side.y(), side.x());  // the corners are counter-clockwise
        margin = std::min(margin, inward.dot(center - support[k]));
      }
      if (margin < least.margin) least = {margin, joint.name, position};
    }
  }
  return least;
}

}  // namespace simwright::importers
