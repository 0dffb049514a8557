#include "pipeline/part_clearing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "assets/joint_poses.h"
#include "core/error.h"
#include "core/progress.h"
#include "geometry/convex_hull.h"
#include "geometry/distance.h"
#include "geometry/weld.h"

namespace simwright::pipeline {
namespace {

using assets::UrdfJoint;
using assets::UrdfModel;

constexpr int kSteps = 48;          // over a joint's range: 2 degrees of a door
constexpr int kMostVertices = 64;   // of a part
constexpr double kLeastLeft = 0.3;  // of a part's volume that a cut has to leave

// A half-space that a part has to stay in: normal . x <= offset, in its link's frame.
struct Cut {
  Eigen::Vector3d normal;
  double offset = 0.0;  // m
};

struct PartPlace {
  size_t link = 0, part = 0;
  bool operator<(const PartPlace& other) const {
    return std::tie(link, part) < std::tie(other.link, other.part);
  }
};

struct Encounter {
  double depth = 0.0;  // m, deepest overlap on the way; negative where only the gap is too small
  std::vector<Cut> cuts;
};

// What the half-space leaves of a convex part; empty where that is nothing with a volume.
core::TriangleMesh CutBy(const core::TriangleMesh& part, const Cut& cut) {
  std::vector<Eigen::Vector3d> points;
  const auto beyond = [&](const Eigen::Vector3d& v) { return cut.normal.dot(v) - cut.offset; };
  for (const Eigen::Vector3d& v : part.vertices) {
    if (beyond(v) <= 0.0) points.push_back(v);
  }
  for (const Eigen::Vector3i& t : part.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = part.vertices[static_cast<size_t>(t[k])];
      const Eigen::Vector3d& b = part.vertices[static_cast<size_t>(t[(k + 1) % 3])];
      const double da = beyond(a), db = beyond(b);
      if (da <= 0.0 && db > 0.0) points.push_back(a + (b - a) * (da / (da - db)));
      if (da > 0.0 && db <= 0.0) points.push_back(b + (a - b) * (db / (db - da)));
    }
  }
  try {
    return geometry::ConvexHull(points, kMostVertices);
  } catch (const core::Error&) {
    return {};
  }
}

// Links that move with the joint. (links)
std::vector<bool> CarriedBy(const UrdfModel& model, const std::vector<int>& parents, size_t joint) {
  std::vector<bool> carried(model.links.size(), false);
  for (size_t i = 0; i < model.joints.size(); ++i) {
    carried[i + 1] = i == joint || carried[static_cast<size_t>(parents[i])];
  }
  return carried;
}

class Clearing {
 public:
  Clearing(const ClearingOptions& options, UrdfModel* model)
      : options_(options), model_(model), parents_(assets::ParentLinks(*model)) {}

  core::Findings Clear() {
    for (size_t joint = 0; joint < model_->joints.size(); ++joint) {
      if (!model_->joints[joint].Moves()) continue;
      core::CheckCancelled();
      Sweep(joint);
      Trim();
    }
    return std::move(findings_);
  }

 private:
  void Sweep(size_t joint) {
    encounters_.clear();
    const UrdfJoint& moved = model_->joints[joint];
    const bool turns = moved.type == assets::UrdfJointType::kContinuous;
    const double lower = turns ? -std::numbers::pi : moved.lower;
    const double upper = turns ? std::numbers::pi : moved.upper;
    const std::vector<bool> carried = CarriedBy(*model_, parents_, joint);
    for (const bool others_up : {false, true}) {
      assets::JointPositions positions;
      for (const UrdfJoint& other : model_->joints) {
        if (others_up && other.Moves()) positions[other.name] = other.upper;
      }
      for (int i = 0; i <= kSteps; ++i) {
        positions[moved.name] = lower + (upper - lower) * i / kSteps;
        Meet(carried, assets::LinkPoses(*model_, positions), others_up);
      }
    }
  }

  const core::TriangleMesh& Mesh(const PartPlace& at) const {
    return model_->links[at.link].collisions[at.part].mesh;
  }

  void Meet(const std::vector<bool>& carried, const std::vector<Eigen::Isometry3d>& poses,
            bool others_up) {
    std::vector<std::pair<PartPlace, Eigen::AlignedBox3d>> moving, still;
    for (size_t link = 0; link < model_->links.size(); ++link) {
      for (size_t part = 0; part < model_->links[link].collisions.size(); ++part) {
        const PartPlace at{link, part};
        (carried[link] ? moving : still)
            .push_back({at, core::Bounds(Mesh(at)).transformed(poses[link])});
      }
    }
    for (const auto& [a, a_box] : moving) {
      if (options_.on_floor && !others_up) MeetFloor(a, poses[a.link]);
      for (const auto& [b, b_box] : still) {
        if (a_box.exteriorDistance(b_box) >= options_.gap) continue;
        MeetPart(a, poses[a.link], b, poses[b.link]);
      }
    }
  }

  void MeetPart(const PartPlace& a, const Eigen::Isometry3d& a_pose, const PartPlace& b,
                const Eigen::Isometry3d& b_pose) {
    const geometry::ConvexDistance found =
        geometry::SignedDistance({Mesh(a).vertices}, a_pose, {Mesh(b).vertices}, b_pose);
    if (found.distance >= 0.9 * options_.gap) return;
    AddCut(a, static_cast<int>(b.link), -found.distance, a_pose, found.normal,
           found.normal.dot(found.point_b));
  }

  void MeetFloor(const PartPlace& a, const Eigen::Isometry3d& a_pose) {
    double lowest = options_.gap;
    for (const Eigen::Vector3d& v : Mesh(a).vertices) lowest = std::min(lowest, (a_pose * v).z());
    if (lowest >= 0.9 * options_.gap) return;
    AddCut(a, kFloor, -lowest, a_pose, -Eigen::Vector3d::UnitZ(), 0.0);
  }

  // Keeps part a on the near side of the plane normal . x = offset (root's frame), less the gap.
  void AddCut(const PartPlace& a, int against, double depth, const Eigen::Isometry3d& a_pose,
              const Eigen::Vector3d& normal, double offset) {
    Encounter& encounter = encounters_[{a, against}];
    encounter.depth = std::max(encounter.depth, depth);
    encounter.cuts.push_back({a_pose.linear().transpose() * normal,
                              offset - options_.gap - normal.dot(a_pose.translation())});
  }

  void Trim() {
    std::map<std::pair<size_t, int>, std::pair<double, bool>> report;  // depth, trimmed
    for (const auto& [key, encounter] : encounters_) {
      const auto& [place, against] = key;
      core::TriangleMesh& mesh = model_->links[place.link].collisions[place.part].mesh;
      bool trimmed = encounter.depth <= options_.most;
      if (trimmed) {
        core::TriangleMesh cut = mesh;
        for (const Cut& plane : encounter.cuts) {
          if (!cut.empty()) cut = CutBy(cut, plane);
        }
        trimmed =
            !cut.empty() && geometry::SignedVolume(cut) > kLeastLeft * geometry::SignedVolume(mesh);
        if (trimmed) mesh = std::move(cut);
      }
      auto& [depth, all] =
          report.emplace(std::pair{place.link, against}, std::pair{0.0, true}).first->second;
      depth = std::max(depth, encounter.depth);
      all = all && trimmed;
    }
    for (const auto& [pair, told] : report) Tell(pair.first, pair.second, told.first, told.second);
  }

  void Tell(size_t link, int against, double depth, bool trimmed) {
    const std::string other = against == kFloor
                                  ? "the floor"
                                  : "'" + model_->links[static_cast<size_t>(against)].name + "'";
    findings_.push_back(
        {trimmed ? "trimmed" : "overlap",
         trimmed ? core::Severity::kInfo : core::Severity::kWarning, model_->links[link].name,
         trimmed ? "its collision parts were trimmed so that they clear " + other
                 : "its collision parts overlap " + other + " by more than is trimmed away",
         1e3 * depth});
  }

  static constexpr int kFloor = -1;
  const ClearingOptions options_;
  UrdfModel* model_;
  const std::vector<int> parents_;
  std::map<std::pair<PartPlace, int>, Encounter> encounters_;  // by part and link (or floor) met
  core::Findings findings_;
};

}  // namespace

core::Findings ClearMovingParts(const ClearingOptions& options, UrdfModel* model) {
  return Clearing(options, model).Clear();
}

}  // namespace simwright::pipeline
