#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "sim/body_rig.h"
#include "sim/drop_test.h"

namespace simwright::sim {

// Runs DropInBullet's experiment in the engine of `rigs`.
DropResult DropBody(const RigidBody& body, const DropOptions& options, const BodyRigFactory& rigs);

struct SlopeOptions {
  double angle = 0.0;      // rad, of the slope
  double direction = 0.0;  // rad, yaw of the downhill direction
  double settle = 0.3;     // s on the level floor before
  double tilt_time = 0.2;  // s, in which the slope rises
  double watch = 0.6;      // s, of the measurement

  bool IsValid(std::string* error) const;
};

struct SlopeResult {
  double displacement = 0.0;  // m, of the farthest point during `watch`
  // m/s^2, of the centre of mass downhill, the mean over `watch`: from its positions at the
  // beginning, in the middle and at the end.
  double acceleration = 0.0;
  double tilt = 0.0;  // rad, of the body's vertical axis during `watch`
};

// Places the body at `world_from_body` on the floor and tilts gravity, which is the slope seen from
// itself. Throws core::Error for invalid options.
SlopeResult StandOnSlope(const RigidBody& body, const Eigen::Isometry3d& world_from_body,
                         const SlopeOptions& options, const BodyRigFactory& rigs);

struct StackResult {
  double settling = 0.0;  // m, the largest displacement of any in the half second before `watch`
  std::vector<double>
      displacements;         // m, of the body's and of each box's farthest point in `watch`
  double penetration = 0.0;  // m, the deepest contact at the end
};

// Places the body and the boxes as given, lets them settle for half a second, then measures how far
// they move in `watch` (s).
StackResult StandInStack(const RigidBody& body, const Eigen::Isometry3d& world_from_body,
                         const std::vector<RigBox>& boxes, double watch,
                         const BodyRigFactory& rigs);

}  // namespace simwright::sim
