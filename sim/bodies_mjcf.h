#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sim/articulated_body.h"

namespace simwright::sim {

// A body and its placement, as Placement in an ArticulatedWorld.
struct MujocoPlacement {
  const ArticulatedBody* body = nullptr;
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = true;
  // The motor force limits (N m or N) by joint; 0: no motor.
  std::vector<double> motor_forces = {};
};

struct BodiesMjcfOptions {
  double time_step = 0.002;  // s
  int contacts = 400;        // that MuJoCo 2.2 reserves memory for, and its constraint rows
  int rows = 2000;
  bool floor = false;  // with the floor z = 0, on which the bodies' own friction applies
};

// Returns the bodies as MJCF: links, inertials, capsules, convex parts, joints with their friction,
// damping and limits, and mimic joints; links of one body do not collide with each other. Bodies,
// joints, motors and equalities are named by MjcfName.
std::string BodiesMjcf(const std::vector<MujocoPlacement>& placements,
                       const BodiesMjcfOptions& options);

// Returns the name of a "link", "joint" or "mesh" of a body: the body's place in `placements`, and
// the link's or joint's index.
std::string MjcfName(const char* kind, std::size_t body, std::size_t index);

}  // namespace simwright::sim
