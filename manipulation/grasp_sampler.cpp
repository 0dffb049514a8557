#include "manipulation/grasp_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/progress.h"
#include "geometry/distance.h"
#include "geometry/triangle_tree.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kStep = 1e-7;          // m past a hit, to find the next one
constexpr int kMostHits = 64;           // of a line
constexpr double kDownwardTilt = 0.5;   // rad by which downward approaches vary
constexpr double kSteepEnough = 0.2;    // sine between a closing axis and the vertical
constexpr double kSupportGap = 0.0015;  // m between the gripper and the plane z = 0

// A surface point where a line leaves the solid.
struct Exit {
  double distance = 0.0;  // m
  Vector3d normal = Vector3d::UnitZ();
};

// Points on a closed surface, and lines through it.
class GraspSurface {
 public:
  explicit GraspSurface(const core::TriangleMesh& mesh) : mesh_(mesh), tree_(mesh) {
    double sum = 0.0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      sum += core::TriangleAreaVector(mesh, static_cast<int>(t)).norm();
      areas_.push_back(sum);
    }
    if (!(sum > 0.0)) throw core::Error("the object's surface has no area");
  }

  // Samples a point by area; none if it lies inside of another part.
  std::optional<std::pair<Vector3d, Vector3d>> Sample(core::Rng& rng) const {
    const double at = core::Uniform(rng) * areas_.back();
    double u = core::Uniform(rng), v = core::Uniform(rng);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto found = std::upper_bound(areas_.begin(), areas_.end(), at) - areas_.begin();
    const size_t t = std::min(static_cast<size_t>(found), mesh_.triangles.size() - 1);
    const Eigen::Vector3i& corners = mesh_.triangles[t];
    const Vector3d& a = mesh_.vertices[static_cast<size_t>(corners[0])];
    const Vector3d& b = mesh_.vertices[static_cast<size_t>(corners[1])];
    const Vector3d& c = mesh_.vertices[static_cast<size_t>(corners[2])];
    const Vector3d normal = tree_.Normal(static_cast<int>(t));
    if (normal.isZero()) return std::nullopt;
    const Vector3d point = a + u * (b - a) + v * (c - a);
    if (DepthBeyond(point, normal) != 0) return std::nullopt;
    return std::make_pair(point, normal);
  }

  // Returns where the line from the surface point `origin` along `direction`, which points inwards,
  // comes out of all parts, up to `reach` (m).
  std::vector<Exit> Exits(const Vector3d& origin, const Vector3d& direction, double reach) const {
    std::vector<Exit> exits;
    int depth = 1;
    double at = kStep;
    for (int i = 0; i < kMostHits; ++i) {
      const auto hit = tree_.FirstHit(origin + at * direction, direction, reach - at);
      if (!hit) break;
      at += hit->distance;
      const Vector3d normal = tree_.Normal(hit->triangle);
      depth += normal.dot(direction) > 0.0 ? -1 : 1;
      if (depth == 0) exits.push_back({at, normal});
      at += kStep;
    }
    return exits;
  }

 private:
  // Returns in how many parts the point lies, just outside of its own surface.
  int DepthBeyond(const Vector3d& point, const Vector3d& normal) const {
    int depth = 0;
    double at = kStep;
    for (int i = 0; i < kMostHits; ++i) {
      const auto hit = tree_.FirstHit(point + at * normal, normal);
      if (!hit) break;
      depth += tree_.Normal(hit->triangle).dot(normal) > 0.0 ? 1 : -1;
      at += hit->distance + kStep;
    }
    return depth;
  }

  const core::TriangleMesh& mesh_;
  geometry::TriangleTree tree_;
  std::vector<double> areas_;  // cumulative, twice the triangles', m^2
};

geometry::ConvexShape ShapeOf(const core::TriangleMesh& part) {
  return {part.vertices, 0.0};
}

// Returns a random unit vector within `angle` (rad) of `axis`, uniform on the cap.
Vector3d InCone(const Vector3d& axis, double angle, core::Rng& rng) {
  const double cosine = core::Uniform(rng, std::cos(angle), 1.0);
  const double turn = core::Uniform(rng, 0.0, 2.0 * std::numbers::pi);
  const Vector3d side = axis.unitOrthogonal();
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return cosine * axis + sine * (std::cos(turn) * side + std::sin(turn) * axis.cross(side));
}

class AntipodalSampler {
 public:
  AntipodalSampler(const GraspObject& object, const sim::GripperModel& gripper,
                   const GraspSamplerOptions& options, core::Rng& rng)
      : gripper_(gripper),
        options_(options),
        rng_(rng),
        down_(-object.support_from_object.linear().row(2).transpose()),
        surface_(object.surface),
        clearance_(object, gripper, options.approach, options.margin) {
    cone_ = std::min(std::atan(object.friction * gripper.friction), options.largest_angle);
    reach_ = core::Bounds(object.surface).diagonal().norm() + 1e-3;
  }

  GraspSampling Sample() {
    while (result_.samples < options_.samples &&
           static_cast<int>(result_.grasps.size()) < options_.candidates) {
      if (++result_.samples % 256 == 0) core::CheckCancelled();
      const auto sample = surface_.Sample(rng_);
      if (!sample) continue;
      const auto& [point, normal] = *sample;
      const Vector3d axis = InCone(-normal, cone_, rng_);
      for (const Exit& exit : surface_.Exits(point, axis, reach_)) {
        TryPair(point, normal, axis, exit);
      }
    }
    return std::move(result_);
  }

 private:
  void TryPair(const Vector3d& point, const Vector3d& normal, const Vector3d& axis,
               const Exit& exit) {
    ++result_.pairs;
    if (exit.normal.dot(axis) < std::cos(cone_)) {
      ++result_.oblique;
      return;
    }
    const double width = exit.distance;
    if (result_.narrowest == 0.0 || width < result_.narrowest) result_.narrowest = width;
    if (width < options_.least_width) {
      ++result_.too_thin;
      return;
    }
    if (width > gripper_.max_opening - 2.0 * options_.least_clearance) {
      ++result_.too_wide;
      return;
    }
    Grasp grasp;
    grasp.width = width;
    grasp.opening = std::min(gripper_.max_opening, width + 2.0 * options_.finger_clearance);
    grasp.contacts = {point, point + width * axis};
    grasp.normals = {normal, exit.normal};
    const Vector3d side = axis.unitOrthogonal();
    bool found = false;
    for (int i = 0; i < options_.approaches; ++i) {
      const double turn = core::Uniform(rng_, 0.0, 2.0 * std::numbers::pi);
      if (AddGrasp(Eigen::AngleAxisd(turn, axis) * side, axis, grasp)) found = true;
    }
    const Vector3d down = down_ - down_.dot(axis) * axis;
    for (int i = 0; i < options_.downward_approaches && down.norm() > kSteepEnough; ++i) {
      const double turn = core::Uniform(rng_, -kDownwardTilt, kDownwardTilt);
      if (AddGrasp(Eigen::AngleAxisd(turn, axis) * down.normalized(), axis, grasp)) found = true;
    }
    if (!found) ++result_.colliding;
  }

  bool AddGrasp(const Vector3d& approach, const Vector3d& axis, Grasp grasp) {
    grasp.object_from_tool.linear() << axis.cross(approach), axis, approach;
    const double offset = core::Uniform(rng_, 0.0, options_.largest_tip_offset);
    grasp.object_from_tool.translation() = grasp.Center() - offset * approach;
    if (!clearance_.IsFree(grasp.object_from_tool, grasp.opening)) return false;
    grasp.clears_support = clearance_.LowestPoint(grasp.object_from_tool) > kSupportGap;
    result_.grasps.push_back(grasp);
    return true;
  }

  const sim::GripperModel& gripper_;
  const GraspSamplerOptions& options_;
  core::Rng& rng_;
  Vector3d down_;  // unit, object frame
  GraspSurface surface_;
  GraspClearance clearance_;
  double cone_ = 0.0;   // rad
  double reach_ = 0.0;  // m
  GraspSampling result_;
};

std::string Millimetres(double length) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.1f mm", 1e3 * length);
  return text;
}

}  // namespace

// Convex shapes with their bounding boxes.
struct GraspClearance::Parts {
  std::vector<geometry::ConvexShape> shapes;
  std::vector<Eigen::AlignedBox3d> boxes;

  void Add(const std::vector<core::TriangleMesh>& meshes) {
    for (const core::TriangleMesh& mesh : meshes) {
      shapes.push_back(ShapeOf(mesh));
      boxes.push_back(core::Bounds(mesh));
    }
  }
};

struct GraspClearance::Shapes {
  Parts object, passed;  // with GraspObject::obstacles; GraspObject::passed
  std::vector<geometry::ConvexShape> palm;
  std::array<std::vector<geometry::ConvexShape>, 2> fingers;  // fully open
  double max_opening = 0.0;
};

GraspClearance::GraspClearance(const GraspObject& object, const sim::GripperModel& gripper,
                               double approach, double margin)
    : approach_(approach), margin_(margin), support_from_object_(object.support_from_object) {
  auto shapes = std::make_unique<Shapes>();
  shapes->object.Add(object.body.parts);
  shapes->object.Add(object.obstacles);
  shapes->passed.Add(object.passed);
  for (size_t p = 0; p < gripper.palm.size(); ++p) {
    if (p < gripper.palm_capsules.size() && gripper.palm_capsules[p]) {
      const sim::Capsule& capsule = *gripper.palm_capsules[p];
      shapes->palm.push_back({{capsule.a, capsule.b}, capsule.radius});
    } else {
      shapes->palm.push_back(ShapeOf(gripper.palm[p]));
    }
  }
  for (size_t i = 0; i < 2; ++i) {
    for (const auto& part : gripper.fingers[i]) shapes->fingers[i].push_back(ShapeOf(part));
  }
  shapes->max_opening = gripper.max_opening;
  shapes_ = std::move(shapes);
}

GraspClearance::~GraspClearance() = default;

bool GraspClearance::IsFree(const Isometry3d& object_from_tool, double opening) const {
  return IsFreeOf(shapes_->object, object_from_tool, opening, approach_) &&
         IsFreeOf(shapes_->passed, object_from_tool, opening, 0.0);
}

bool GraspClearance::IsFreeOf(const Parts& parts, const Isometry3d& object_from_tool,
                              double opening, double approach) const {
  if (parts.shapes.empty()) return true;
  const double closing = 0.5 * (shapes_->max_opening - opening);
  const Vector3d back = -approach * object_from_tool.linear().col(2);
  geometry::ConvexShape swept;
  const auto is_free = [&](const geometry::ConvexShape& shape, double shift) {
    // The hull of a convex shape at both ends of a straight path is all that it sweeps.
    swept.vertices.clear();
    swept.radius = shape.radius;
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : shape.vertices) {
      const Vector3d here = object_from_tool * Vector3d(vertex + shift * Vector3d::UnitY());
      swept.vertices.push_back(here);
      box.extend(here);
      if (approach <= 0.0) continue;
      swept.vertices.push_back(here + back);
      box.extend(here + back);
    }
    const Vector3d reach = Vector3d::Constant(shape.radius + margin_);
    box.min() -= reach;
    box.max() += reach;
    for (size_t p = 0; p < parts.shapes.size(); ++p) {
      if (!box.intersects(parts.boxes[p])) continue;
      if (!geometry::AreApart(swept, parts.shapes[p], margin_)) return false;
    }
    return true;
  };
  const auto are_free = [&](const std::vector<geometry::ConvexShape>& shapes, double shift) {
    return std::all_of(shapes.begin(), shapes.end(),
                       [&](const auto& shape) { return is_free(shape, shift); });
  };
  return are_free(shapes_->fingers[0], -closing) && are_free(shapes_->fingers[1], closing) &&
         are_free(shapes_->palm, 0.0);
}

double GraspClearance::LowestPoint(const Isometry3d& object_from_tool) const {
  const Isometry3d support_from_tool = support_from_object_ * object_from_tool;
  double lowest = HUGE_VAL;
  for (const auto* shapes : {&shapes_->palm, &shapes_->fingers[0], &shapes_->fingers[1]}) {
    for (const geometry::ConvexShape& shape : *shapes) {
      for (const Vector3d& vertex : shape.vertices) {
        lowest = std::min(lowest, (support_from_tool * vertex).z() - shape.radius);
      }
    }
  }
  const double back = -approach_ * support_from_tool.linear()(2, 2);
  return lowest + std::min(0.0, back);
}

bool GraspSamplerOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (candidates < 1 || samples < 1 || approaches < 1 || downward_approaches < 0) {
    return fail("candidates, samples and approaches must be positive");
  }
  if (!(largest_tip_offset >= 0.0)) return fail("largest_tip_offset must not be negative");
  if (!(largest_angle > 0.0) || largest_angle > 1.5) return fail("largest_angle must be 0 to 1.5");
  if (!(least_width >= 0.0) || !(least_clearance >= 0.0) ||
      !(finger_clearance >= least_clearance)) {
    return fail("finger_clearance must be at least least_clearance, and no length negative");
  }
  if (!(approach >= 0.0) || !(margin >= 0.0)) return fail("no length may be negative");
  return true;
}

std::string GraspSampling::WhyNone(const sim::GripperModel& gripper) const {
  if (!grasps.empty()) return "";
  if (too_wide + too_thin + colliding == 0) {
    return "no two points of its surface face each other within the friction cone";
  }
  if (too_thin >= too_wide + colliding) {
    return "it is " + Millimetres(narrowest) + " thin: the fingers have nothing to press on";
  }
  if (too_wide >= colliding) {
    return "it is wider than the hand: its narrowest place is " + Millimetres(narrowest) +
           ", the fingers open by " + Millimetres(gripper.max_opening);
  }
  return "the gripper collides with it from every direction that was tried";
}

GraspSampling SampleAntipodalGrasps(const GraspObject& object, const sim::GripperModel& gripper,
                                    const GraspSamplerOptions& options, core::Rng& rng) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("grasp sampler: " + error);
  if (object.surface.empty() || object.body.parts.empty()) {
    throw core::Error("an object needs a surface and collision parts", object.name);
  }
  return AntipodalSampler(object, gripper, options, rng).Sample();
}

}  // namespace simwright::manipulation
