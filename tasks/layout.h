#pragma once

#include <optional>
#include <vector>

#include "core/random.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

// The support relation of an object at the start.
struct SupportRelation {
  int object = -1;
  int holder = -1;      // the object that supports or contains it
  int receptacle = -1;  // the holder's receptacle; in its front where it opens to a side; -1: on
                        // top of it
};

struct LayoutRequest {
  std::vector<int> objects;  // all objects to place
  std::vector<SupportRelation> supports;
  // The joints that the robot must be able to reach, as pairs of object and joint.
  std::vector<std::pair<int, int>> operated;
  // The joints that do not start at their rest position.
  std::vector<JointCondition> joints;
};

// Places objects in front of the robot. Articulated objects are fixed to the world and face the
// robot, at a distance, a lateral offset and a height of the robot's base from which the robot can
// reach the handles along their whole path (or at least 0.8 of it). Other objects are placed beside
// them within reach, or where `supports` specifies. Footprints do not overlap. Returns nullopt if
// no such placement is found.
std::optional<InitialState> PlanLayout(const WorldModel& model, const LayoutRequest& request,
                                       core::Rng& rng);

// Returns true if a Panda on its base can bring the point between its fingertips to `point` (m,
// world).
bool IsPointReachable(const Eigen::Isometry3d& world_from_robot, const Eigen::Vector3d& point,
                      const std::optional<Eigen::Vector3d>& approach = std::nullopt);

}  // namespace simwright::tasks
