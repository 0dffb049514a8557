#include "validation/joint_clearance.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "asset_build/link_overlap.h"
#include "assets/joint_poses.h"
#include "core/parallel.h"
#include "geometry/distance.h"

namespace simwright::validation {
namespace {

constexpr int kSteps = 24;  // over the range: 4 degrees of a door

struct Part {
  int link = 0;
  geometry::ConvexShape shape;
  Eigen::AlignedBox3d box;  // in the link's frame
};

std::vector<Part> PartsOf(const assets::UrdfModel& model) {
  std::vector<Part> parts;
  for (size_t i = 0; i < model.links.size(); ++i) {
    for (const assets::UrdfShape& shape : model.links[i].collisions) {
      parts.push_back({static_cast<int>(i), {shape.mesh.vertices, 0.0}, core::Bounds(shape.mesh)});
    }
  }
  return parts;
}

// Returns one of kSteps + 1 positions over the joint's range, or over a full turn for a joint
// without limits.
double PositionAt(const assets::Joint& joint, int step) {
  const bool turns = joint.type == assets::JointType::kContinuous;
  const double lower = turns ? -std::numbers::pi : joint.lower;
  const double upper = turns ? std::numbers::pi : joint.upper;
  return lower + (upper - lower) * step / kSteps;
}

assets::JointPositions Positions(const assets::UrdfModel& model, int joint, double position,
                                 bool others_up) {
  assets::JointPositions positions;
  for (const assets::Joint& other : model.joints) {
    if (others_up && other.Moves()) positions[other.name] = other.upper;
  }
  positions[model.joints[static_cast<size_t>(joint)].name] = position;
  return positions;
}

// Marks the pairs of links that are excluded from contact. (links x links)
std::vector<std::vector<bool>> ExcludedIn(const assets::UrdfModel& model) {
  std::vector<std::vector<bool>> excluded(model.links.size());
  for (size_t a = 0; a < model.links.size(); ++a) {
    for (size_t b = 0; b < model.links.size(); ++b) {
      excluded[a].push_back(asset_build::IsExcluded(model, a, b));
    }
  }
  return excluded;
}

void Tighten(const std::vector<Part>& parts, const std::vector<bool>& carried,
             const std::vector<std::vector<bool>>& excluded,
             const std::vector<Eigen::Isometry3d>& poses, const assets::UrdfModel& model,
             double position, Clearance* least) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Part& part : parts) {
    boxes.push_back(part.box.transformed(poses[static_cast<size_t>(part.link)]));
  }
  for (size_t a = 0; a < parts.size(); ++a) {
    if (!carried[static_cast<size_t>(parts[a].link)]) continue;
    for (size_t b = 0; b < parts.size(); ++b) {
      if (carried[static_cast<size_t>(parts[b].link)]) continue;
      if (excluded[static_cast<size_t>(parts[a].link)][static_cast<size_t>(parts[b].link)])
        continue;
      if (boxes[a].exteriorDistance(boxes[b]) >= std::max(least->distance, 1e-6)) continue;
      const double distance =
          geometry::SignedDistance(parts[a].shape, poses[static_cast<size_t>(parts[a].link)],
                                   parts[b].shape, poses[static_cast<size_t>(parts[b].link)])
              .distance;
      if (distance >= least->distance) continue;
      *least = {distance, position,
                model.links[static_cast<size_t>(parts[a].link)].name + " and " +
                    model.links[static_cast<size_t>(parts[b].link)].name};
    }
  }
}

}  // namespace

Clearance SweptClearance(const assets::UrdfModel& model, int joint, bool others_up) {
  const std::vector<Part> parts = PartsOf(model);
  const std::vector<bool> carried =
      asset_build::LinkGroups(model).CarriedBy(static_cast<size_t>(joint));
  const std::vector<std::vector<bool>> excluded = ExcludedIn(model);
  const assets::Joint& moved = model.joints.at(static_cast<size_t>(joint));
  std::vector<Clearance> at(kSteps + 1, {std::numeric_limits<double>::infinity(), moved.lower, ""});
  core::ParallelFor(kSteps + 1, [&](int i) {
    const double position = PositionAt(moved, i);
    const auto poses = assets::LinkPoses(model, Positions(model, joint, position, others_up));
    Tighten(parts, carried, excluded, poses, model, position, &at[static_cast<size_t>(i)]);
  });
  return *std::min_element(at.begin(), at.end(), [](const Clearance& a, const Clearance& b) {
    return a.distance < b.distance;
  });
}

Clearance SweptClearance(const assets::UrdfModel& model, int joint) {
  const Clearance zero = SweptClearance(model, joint, false);
  const auto moving = std::count_if(model.joints.begin(), model.joints.end(),
                                    [](const auto& j) { return j.Moves(); });
  if (moving == 1) return zero;  // there is no other moving joint
  const Clearance up = SweptClearance(model, joint, true);
  return up.distance < zero.distance ? up : zero;
}

double LowestOnSweep(const assets::UrdfModel& model, int joint) {
  const assets::Joint& moved = model.joints.at(static_cast<size_t>(joint));
  const std::vector<bool> carried =
      asset_build::LinkGroups(model).CarriedBy(static_cast<size_t>(joint));
  const std::vector<bool> bears = asset_build::SupportingLinks(model);
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    const double position = PositionAt(moved, i);
    const auto poses = assets::LinkPoses(model, Positions(model, joint, position, false));
    for (size_t link = 0; link < model.links.size(); ++link) {
      if (carried[link] && !bears[link]) {
        lowest = std::min(lowest, asset_build::LowestOf(model.links[link], poses[link]));
      }
    }
  }
  return lowest;
}

}  // namespace simwright::validation
