#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

// A jointed thing as Placement puts it into an ArticulatedWorld.
struct MujocoPlacement {
  const ArticulatedBody* body = nullptr;
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = true;
  // Of each joint, in order: N m or N that a motor may hold it with; 0: without a motor.
  std::vector<double> motor_forces = {};
};

// The same things in MuJoCo, over the floor, to compare speeds: links, inertials, capsules, convex
// parts, joints with their friction, damping and limits, mimicked joints tied; a thing's own links
// do not touch each other. One thread a world.
class MujocoBodies {
 public:
  // `time_step`: s. Throws core::Error where MuJoCo refuses the model, in its own words.
  MujocoBodies(const std::vector<MujocoPlacement>& placements, double time_step);
  ~MujocoBodies();
  MujocoBodies(const MujocoBodies&) = delete;
  MujocoBodies& operator=(const MujocoBodies&) = delete;

  // Moves the joint (ArticulatedBody::joints) there at once, all at rest.
  void SetPosition(int body, int joint, double position);
  // What the joint's motor holds from now on, rad or m.
  void Hold(int body, int joint, double position);
  void Step();

  double Position(int body, int joint) const;            // rad or m
  Eigen::Isometry3d LinkPose(int body, int link) const;  // world_from_link
  int ContactCount() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace simwright::sim
