#include "importers/range_limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "asset_build/link_overlap.h"
#include "assets/joint_poses.h"
#include "core/finding_text.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::importers {
namespace {

using assets::Joint;
using assets::UrdfModel;

constexpr double kOvershoot = 0.015;  // of the free range: engines overrun limits
constexpr int kRangeSteps = 48;       // positions over a joint's range: 2 degrees of a door
constexpr int kBisections = 8;        // of one step

struct Obstacle {
  double depth = 0.0;  // m
  std::string name;    // the link's, or "the floor"
  bool floor = false;
};

class RangeLimiter {
 public:
  RangeLimiter(const RangeOptions& options, UrdfModel* model)
      : options_(options), model_(model), groups_(*model) {}

  RangeResult LimitRanges() {
    ExcludePairsOverlappingAtZero();
    for (size_t joint = 0; joint < model_->joints.size(); ++joint) {
      if (!options_.limit_ranges || !model_->joints[joint].Moves()) continue;
      core::CheckCancelled();
      LimitRange(joint);
    }
    return std::move(result_);
  }

 private:
  void ExcludePairsOverlappingAtZero() {
    const auto poses = assets::LinkPosesAtZero(*model_);
    for (size_t a = 0; a < model_->links.size(); ++a) {
      for (size_t b = 0; b < a; ++b) {
        if (groups_.Rigid(a, b) || groups_.Adjacent(a, b)) continue;
        const double depth = asset_build::OverlapOf(*model_, poses, a, b);
        if (depth <= options_.most) continue;
        model_->excluded_pairs.emplace_back(model_->links[a].name, model_->links[b].name);
        result_.findings.push_back(
            {"overlap-excluded", core::Severity::kWarning, model_->links[a].name,
             "it overlaps '" + model_->links[b].name +
                 "', which is not a neighbour by a joint, by " + core::Millimetres(depth) +
                 " with all joints at zero: the pair is excluded from contact",
             1e3 * depth, "repair the file's meshes to enable contact between them"});
      }
    }
  }

  Obstacle ObstacleAt(size_t joint, const std::vector<bool>& carried, double position) const {
    const auto poses = assets::LinkPoses(*model_, {{model_->joints[joint].name, position}});
    Obstacle worst;
    for (size_t a = 0; a < carried.size(); ++a) {
      if (!carried[a]) continue;
      if (options_.on_floor) {
        for (const assets::UrdfShape& shape : model_->links[a].collisions) {
          for (const Eigen::Vector3d& v : shape.mesh.vertices) {
            const double depth = -(poses[a] * v).z();
            if (depth > worst.depth) worst = {depth, "the floor", true};
          }
        }
      }
      for (size_t b = 0; b < carried.size(); ++b) {
        if (carried[b] || groups_.Adjacent(a, b) || asset_build::IsExcluded(*model_, a, b))
          continue;
        const double depth = asset_build::OverlapOf(*model_, poses, a, b);
        if (depth > worst.depth) worst = {depth, "'" + model_->links[b].name + "'", false};
      }
    }
    return worst;
  }

  void LimitRange(size_t index) {
    Joint& joint = model_->joints[index];
    const bool turns = joint.type == assets::JointType::kContinuous;
    const double lower = turns ? -std::numbers::pi : joint.lower;
    const double upper = turns ? std::numbers::pi : joint.upper;
    const std::vector<bool> carried = groups_.CarriedBy(index);
    const auto blocked = [&](double position, Obstacle* what) {
      *what = ObstacleAt(index, carried, position);
      return what->depth > options_.most;
    };
    Obstacle first, worst;
    if (blocked(0.0, &first)) return;  // already blocked at zero: no range helps
    const double step = (upper - lower) / kRangeSteps;
    std::vector<Obstacle> at(kRangeSteps + 1);
    core::ParallelFor(kRangeSteps + 1, [&](int i) {
      at[static_cast<size_t>(i)] = ObstacleAt(index, carried, lower + step * i);
    });
    double ends[2] = {lower, upper};
    for (const int direction : {-1, 1}) {
      const double limit = direction < 0 ? lower : upper;
      // The last free position before the first blocked one, going out from zero.
      double free = 0.0;
      const Obstacle* hit = nullptr;
      double hit_at = limit;
      const int start = static_cast<int>(std::floor(-lower / step));
      for (int i = direction < 0 ? start : start + 1; i >= 0 && i <= kRangeSteps; i += direction) {
        const double position = lower + step * i;
        if (direction * position <= 0.0) continue;
        if (at[static_cast<size_t>(i)].depth > options_.most) {
          hit = &at[static_cast<size_t>(i)];
          hit_at = position;
          break;
        }
        free = position;
      }
      if (hit == nullptr) continue;
      if (hit->depth > worst.depth) worst = *hit;
      Obstacle what;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (free + hit_at);
        (blocked(middle, &what) ? hit_at : free) = middle;
      }
      ends[direction < 0 ? 0 : 1] = (1.0 - kOvershoot) * free;
    }
    if (worst.depth == 0.0) return;
    const double left = (ends[1] - ends[0]) / (upper - lower);
    if (left < options_.least_left) {
      if (worst.floor) result_.floor_in_the_way = true;
      return;
    }
    char figures[96], share[32];
    std::snprintf(figures, sizeof(figures), " from [%.3g, %.3g] to [%.3g, %.3g]", lower, upper,
                  ends[0], ends[1]);
    std::snprintf(share, sizeof(share), ": %.0f %% remains", 100.0 * left);
    const bool slides = joint.type == assets::JointType::kPrismatic;
    result_.findings.push_back({"joint-cut", core::Severity::kWarning, joint.name,
                                "its range was reduced" + std::string(figures) +
                                    (slides ? " m" : " rad") + ", where it would collide with " +
                                    worst.name + share,
                                left, worst.floor ? "mount it higher, and widen the limit" : ""});
    if (turns) joint.type = assets::JointType::kRevolute;
    joint.lower = ends[0];
    joint.upper = ends[1];
  }

  const RangeOptions options_;
  UrdfModel* model_;
  const asset_build::LinkGroups groups_;
  RangeResult result_;
};

}  // namespace

RangeResult LimitRangesAtObstacles(const RangeOptions& options, UrdfModel* model) {
  return RangeLimiter(options, model).LimitRanges();
}

}  // namespace simwright::importers
