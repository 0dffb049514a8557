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

// A subtask on the assets that it names.
struct SkillSubtask {
  std::vector<assets::SemanticModel> assets;
  tasks::Subtask subtask;
  std::optional<tasks::Subtask> next;  // what follows it in its task
};

// One scene that a skill is practised in. Constant.
struct SkillVariant {
  tasks::SceneModel model;
  std::vector<std::shared_ptr<const sim::PreparedBody>> bodies;  // by thing
  std::vector<BodySolids> solids;                                // of the bodies
  // Of each of a thing's joints its place in the body's; by thing.
  std::vector<std::vector<int>> body_joints;
  tasks::Subtask subtask;
  tasks::SceneState start;      // as the subtask describes it
  std::vector<int> placed;      // things that it places
  std::vector<bool> fixed;      // by thing
  std::vector<int> carried_by;  // by thing: what it stands in or on; -1: the floor
  std::optional<tasks::RewardProgram> program;
  std::optional<Focus> focus;
  std::optional<Destination> destination;
  // Where the subtask that follows brings the thing that this one takes: it is taken so that it can
  // go there. None where that does not go on with it, or to a place on the way.
  std::optional<Destination> next;
  // The room that the hand goes into: the destination's, that of the thing at the start, or next's.
  std::optional<SideRoom> room;
  bool asks_for_grasp = false;
  bool starts_held = false;
};

// What a policy learns: one subtask, in one scene or in several alike (a door on six microwaves).
// Constant; shared by all environments.
struct Skill {
  const robot::RobotModel* robot = nullptr;
  std::shared_ptr<const sim::PreparedBody> robot_body;
  std::vector<SurfacePoints> robot_surface;  // by link of its URDF (RobotSurface)
  std::shared_ptr<const robot::PoseInverseKinematics> kinematics;
  std::shared_ptr<const robot::ChainKinematics> chain;
  SkillOptions options;
  std::vector<SkillVariant> variants;  // at least one; all read slots of the same kinds
  // What follows in the task that this begins, as many variants each: where it is begun, the arm
  // can do that too (DrawStart). Empty: nothing, or this is not the first.
  std::vector<std::shared_ptr<const Skill>> later;
};

// Prepares `subtasks` for `robot`, which must outlive the skill. Throws core::Error where there is
// none, options are not valid, a program does not compile or has no success, a thing cannot be
// simulated, two of the programs read different things, or one of `later` has another number of
// variants.
std::shared_ptr<const Skill> MakeSkill(const robot::RobotModel& robot,
                                       const std::vector<SkillSubtask>& subtasks,
                                       const SkillOptions& options = {},
                                       std::vector<std::shared_ptr<const Skill>> later = {});

}  // namespace simwright::rl
