#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assets/semantic_model.h"
#include "rl/convex_solid.h"
#include "rl/focus.h"
#include "rl/skill_options.h"
#include "robot/pose_inverse_kinematics.h"
#include "robot/robot_model.h"
#include "sim/articulated_world.h"
#include "tasks/reward/reward_program.h"
#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::rl {

// A subtask and the assets that it names.
struct SkillSubtask {
  std::vector<assets::SemanticModel> assets;
  tasks::Subtask subtask;
  std::optional<tasks::Subtask> next;  // the next subtask of the task
};

// One scene of a skill. Constant.
struct SkillVariant {
  tasks::SceneModel model;
  std::vector<std::shared_ptr<const sim::PreparedBody>> bodies;  // by object
  std::vector<BodySolids> solids;                                // of the bodies
  // The index of each of an object's joints in its body; by object.
  std::vector<std::vector<int>> body_joints;
  tasks::Subtask subtask;
  tasks::SceneState start;      // as described by the subtask
  std::vector<int> placed;      // objects placed by the subtask
  std::vector<bool> fixed;      // by object
  std::vector<int> carried_by;  // by object: what it stands in or on; -1: the floor
  std::optional<tasks::RewardProgram> program;
  std::optional<Focus> focus;
  std::optional<Destination> destination;
  // The destination of the grasped object in the next subtask: the grasp must permit it. None if
  // the next subtask does not carry the object on, or only to a goal position.
  std::optional<Destination> next;
  // The receptacle that the gripper enters: the destination's, the one around the object at the
  // start, or that of `next`.
  std::optional<SideRoom> room;
  bool asks_for_grasp = false;
  bool starts_held = false;
};

// The skill that a policy learns: one subtask, in one scene or in several similar ones (a door on
// six microwaves). Constant; shared by all environments.
struct Skill {
  const robot::RobotModel* robot = nullptr;
  std::shared_ptr<const sim::PreparedBody> robot_body;
  std::vector<SurfacePoints> robot_surface;  // by link of its URDF (RobotSurface)
  std::shared_ptr<const robot::PoseInverseKinematics> kinematics;
  std::shared_ptr<const robot::ChainKinematics> chain;
  SkillOptions options;
  std::vector<SkillVariant> variants;  // at least one; all read slots of the same kinds
  // The later skills of the task that this skill begins, with as many variants each: start states
  // are sampled such that the arm can do them too (DrawStart). Empty: no later skills, or this is
  // not the first.
  std::vector<std::shared_ptr<const Skill>> later;
};

// Prepares `subtasks` for `robot`, which must outlive the skill. Throws core::Error if there is no
// subtask, an option is invalid, a program does not compile or has no success, an object cannot be
// simulated, two of the programs read different inputs, or one of `later` has another number of
// variants.
std::shared_ptr<const Skill> MakeSkill(const robot::RobotModel& robot,
                                       const std::vector<SkillSubtask>& subtasks,
                                       const SkillOptions& options = {},
                                       std::vector<std::shared_ptr<const Skill>> later = {});

}  // namespace simwright::rl
