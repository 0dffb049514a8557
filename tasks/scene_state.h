#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/reward/reward_scene.h"
#include "tasks/task.h"
#include "tasks/thing.h"

namespace simwright::tasks {

// The things that tasks may name. Constant; shared by any number of states.
struct SceneModel {
  std::vector<Thing> things;
  RewardScene names;  // the same, as programs may name them

  int Find(const std::string& name) const;  // -1: none
};

// One moment of an episode: where everything is. World frame, m, rad.
struct SceneState {
  std::vector<Eigen::Isometry3d> roots;     // world_from_root, by thing
  std::vector<std::vector<double>> joints;  // positions, by thing and joint
  // The tool between the fingertips: z along the approach, y from finger to finger.
  Eigen::Isometry3d gripper = Eigen::Isometry3d::Identity();
  double opening = 0.08;                           // m between the fingers
  int touched = -1, touched_link = -1;             // thing and link that a finger touches
  bool grasped = false;                            // and both fingers hold
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();  // what get_goal_pose gives
};

// The model of `assets`, named as there. Throws core::Error where two share a name.
SceneModel MakeSceneModel(const std::vector<assets::SemanticModel>& models);

// The state that `start` describes, the gripper at the robot's ready posture. Things that it does
// not place stand far away, 100 m below the floor. Throws core::Error for an asset or joint that
// the model does not have.
SceneState StateOf(const SceneModel& model, const InitialState& start,
                   const std::optional<Eigen::Vector3d>& goal = std::nullopt);

// Where a link is: the middle of its own box, m. Also of what the API calls an asset's position:
// the middle of the root's box.
Eigen::Vector3d LinkPoint(const SceneModel& model, const SceneState& state, int thing, int link);

// Along the world's axes; of all links where `link` is -1.
Eigen::AlignedBox3d WorldBox(const SceneModel& model, const SceneState& state, int thing,
                             int link = -1);

}  // namespace simwright::tasks
