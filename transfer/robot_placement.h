#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tasks/world_state.h"

namespace simwright::transfer {

// A place of a robot's base on the plane of a table.
struct RobotPlacement {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
  std::vector<bool> reached;  // by object: a gripper from above reaches its middle

  int count() const;  // of the objects reached
};

// Returns the placement with the base at `world_from_robot`.
RobotPlacement PlacementAt(const tasks::WorldModel& model, const tasks::WorldState& state,
                           const Eigen::Isometry3d& world_from_robot);

// Returns the place, standing on z = 0 and facing the middle of the objects, from which a Panda
// reaches most of them: of a grid around that middle, on the side of the origin, the one nearest to
// the line from the origin. No object is nearer to the base than 25 cm.
RobotPlacement PlaceRobot(const tasks::WorldModel& model, const tasks::WorldState& state);

}  // namespace simwright::transfer
