#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "reward/reward_scene.h"
#include "tasks/articulated_object.h"
#include "tasks/task.h"

namespace simwright::tasks {

// The objects that tasks may name. Immutable; shared by any number of states.
struct WorldModel {
  std::vector<ArticulatedObject> objects;
  reward::RewardScene names;  // the same objects as programs may name them

  int Find(const std::string& name) const;  // -1: none
};

// The poses, joint positions and gripper state at one time of an episode. World frame, m, rad.
struct WorldState {
  std::vector<Eigen::Isometry3d> roots;     // world_from_root, by object
  std::vector<std::vector<double>> joints;  // positions, by object and joint
  // The tool frame between the fingertips: z along the approach, y from finger to finger.
  Eigen::Isometry3d gripper = Eigen::Isometry3d::Identity();
  double opening = 0.08;                           // distance between the fingers, m
  int touched = -1, touched_link = -1;             // the object and link that a finger touches
  bool grasped = false;                            // true if both fingers hold it
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();  // the value of get_goal_pose
};

// Returns the model of `models`, with their names. Throws core::Error if two share a name.
WorldModel MakeWorldModel(const std::vector<assets::SemanticModel>& models);

// Returns the state that `start` describes, with the gripper at the robot's ready configuration.
// Objects without a placement are put 100 m below the floor. Throws core::Error for an asset or
// joint that the model does not have.
WorldState StateOf(const WorldModel& model, const InitialState& start,
                   const std::optional<Eigen::Vector3d>& goal = std::nullopt);

// Returns the position of a link: the centre of its own bounding box, m. The API's position of an
// asset is that of its root link.
Eigen::Vector3d LinkPosition(const WorldModel& model, const WorldState& state, int object,
                             int link);

// Returns the AABB in the world frame; of all links where `link` is -1.
Eigen::AlignedBox3d WorldAabb(const WorldModel& model, const WorldState& state, int object,
                              int link = -1);

}  // namespace simwright::tasks
