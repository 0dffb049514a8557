#include "pipeline/joint_clearance.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "assets/joint_poses.h"
#include "geometry/distance.h"

namespace simwright::pipeline {
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

// Links beyond the joint. (links)
std::vector<bool> CarriedBy(const assets::UrdfModel& model, int joint) {
  const std::vector<int> parents = assets::ParentLinks(model);
  std::vector<bool> carried(model.links.size(), false);
  for (size_t i = 0; i < model.joints.size(); ++i) {
    carried[i + 1] = static_cast<int>(i) == joint || carried[static_cast<size_t>(parents[i])];
  }
  return carried;
}

assets::JointPositions Positions(const assets::UrdfModel& model, int joint, double position,
                                 bool others_up) {
  assets::JointPositions positions;
  for (const assets::UrdfJoint& other : model.joints) {
    if (others_up && other.Moves()) positions[other.name] = other.upper;
  }
  positions[model.joints[static_cast<size_t>(joint)].name] = position;
  return positions;
}

void Tighten(const std::vector<Part>& parts, const std::vector<bool>& carried,
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

Clearance SweptClearance(const assets::UrdfModel& model, int joint) {
  const std::vector<Part> parts = PartsOf(model);
  const std::vector<bool> carried = CarriedBy(model, joint);
  const assets::UrdfJoint& moved = model.joints.at(static_cast<size_t>(joint));
  Clearance least{std::numeric_limits<double>::infinity(), moved.lower, ""};
  for (const bool others_up : {false, true}) {
    for (int i = 0; i <= kSteps; ++i) {
      const double position = moved.lower + (moved.upper - moved.lower) * i / kSteps;
      const auto poses = assets::LinkPoses(model, Positions(model, joint, position, others_up));
      Tighten(parts, carried, poses, model, position, &least);
    }
  }
  return least;
}

double LowestOnSweep(const assets::UrdfModel& model, int joint) {
  const assets::UrdfJoint& moved = model.joints.at(static_cast<size_t>(joint));
  const std::vector<bool> carried = CarriedBy(model, joint);
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    const double position = moved.lower + (moved.upper - moved.lower) * i / kSteps;
    const auto poses = assets::LinkPoses(model, Positions(model, joint, position, false));
    for (size_t link = 0; link < model.links.size(); ++link) {
      if (!carried[link]) continue;
      for (const assets::UrdfShape& shape : model.links[link].collisions) {
        for (const Eigen::Vector3d& v : shape.mesh.vertices) {
          lowest = std::min(lowest, (poses[link] * v).z());
        }
      }
    }
  }
  return lowest;
}

}  // namespace simwright::pipeline
