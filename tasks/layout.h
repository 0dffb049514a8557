#pragma once

#include <optional>
#include <vector>

#include "core/random.h"
#include "tasks/scene_state.h"

namespace simwright::tasks {

// Where one thing is relative to another at the start.
struct Resting {
  int thing = -1;
  int holder = -1;  // the thing that it stands in or on
  int cavity = -1;  // of the holder: in its front, where it opens to a side; -1: on top of it
};

struct LayoutRequest {
  std::vector<int> things;  // all that are placed
  std::vector<Resting> resting;
  // Joints that the robot shall be able to reach, by thing and joint.
  std::vector<std::pair<int, int>> worked;
  // Joints that do not stand at rest.
  std::vector<JointCondition> joints;
};

// Places things in front of the robot: what is articulated stands before it, held to the world and
// facing it, at a distance, to a side and against a height of the robot's base that let it reach
// the handles along their whole way (or at least 0.8 of it); what is not stands beside, within
// reach, or where `resting` says. Nothing overlaps. Empty where no such place is found.
std::optional<InitialState> LayOut(const SceneModel& model, const LayoutRequest& request,
                                   core::Rng& rng);

// Whether a Panda on its base can bring the point between its fingertips to `point` (m, world).
bool Reaches(const Eigen::Isometry3d& world_from_robot, const Eigen::Vector3d& point,
             const std::optional<Eigen::Vector3d>& approach = std::nullopt);

}  // namespace simwright::tasks
