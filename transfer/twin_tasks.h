#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "core/progress.h"
#include "workflows/tasks/task_making.h"

namespace simwright::transfer {

struct TwinTasksRequest {
  std::filesystem::path twin;    // a folder written by `simwright twin`
  std::filesystem::path output;  // tasks.json
  int count = 0;                 // 0: five per object
  // The robot's base on the plane of the table: x, y (m, the twin's frame) and yaw (rad). None:
  // where it reaches most objects, on the camera's side (PlaceRobot).
  std::optional<Eigen::Vector3d> robot;
  std::uint64_t seed = 1;
  bool force = false;
};

// Generates tasks by rules about the objects of a twin, which start as the twin shows them: every
// object stands in its place, articulated ones are fixed, and the robot's base stands on the plane
// of the table. The findings state where (`twin-robot-placed`) and which objects it does not reach
// (`twin-out-of-reach`). Throws core::Error for a folder without a twin, a twin without objects,
// one of whose objects the robot reaches none, and wherever workflows::MakeTasks does.
workflows::TasksReport MakeTwinTasks(const TwinTasksRequest& request, core::Progress* progress);

}  // namespace simwright::transfer
