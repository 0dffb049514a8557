#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "sim/bodies_mjcf.h"

namespace simwright::sim {

// The same bodies in MuJoCo, above the floor, for speed comparisons: links, inertials, capsules,
// convex parts, joints with their friction, damping and limits, and mimic joints; links of one body
// do not collide with each other. One thread per world.
class MujocoBodies {
 public:
  // `time_step`: s. Throws core::Error with MuJoCo's own message if MuJoCo rejects the model.
  MujocoBodies(const std::vector<MujocoPlacement>& placements, double time_step);
  ~MujocoBodies();
  MujocoBodies(const MujocoBodies&) = delete;
  MujocoBodies& operator=(const MujocoBodies&) = delete;

  // Teleports the joint (index into ArticulatedBody::joints), all at rest.
  void SetPosition(int body, int joint, double position);
  // Sets the position target of the joint's motor, rad or m.
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
