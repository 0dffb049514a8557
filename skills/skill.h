#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assets/link_visuals.h"
#include "assets/semantic_model.h"
#include "manipulation/grasp.h"
#include "manipulation/interaction.h"
#include "reward/reward_program.h"
#include "robot/pose_inverse_kinematics.h"
#include "robot/robot_model.h"
#include "sim/articulated_world.h"
#include "skills/skill_options.h"
#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::skills {

// A subtask and the assets that it names.
struct SkillSubtask {
  std::vector<assets::SemanticModel> assets;
  // The proved grasps of assets by the robot's gripper, by name of the asset; in the frame of the
  // asset, or of the link of an articulated one.
  std::map<std::string, std::vector<manipulation::Grasp>> grasps;
  tasks::Subtask subtask;
  std::optional<tasks::Subtask> next;  // the next subtask of the task
};

// One scene of a skill. Constant.
struct SkillVariant : manipulation::Interaction {
  // The index of each of an object's joints in its body; by object.
  std::vector<std::vector<int>> body_joints;
  std::vector<bool> fixed;                               // by object
  std::vector<std::vector<assets::LinkVisual>> visuals;  // by object; links of its kinematic model
  std::vector<int> carried_by;  // by object: what it stands in or on; -1: the floor
  std::optional<reward::RewardProgram> program;
};

// The skill that a policy learns: one subtask, in one scene or in several similar ones (a door on
// six microwaves). Constant; shared by all environments.
struct Skill : manipulation::PlanningArm {
  std::shared_ptr<const sim::PreparedBody> robot_body;
  SkillOptions options;
  std::vector<SkillVariant> variants;  // at least one; all read slots of the same kinds
  // The later skills of the task that this skill begins, with as many variants each: start states
  // are sampled such that the arm can do them too (SampleStart). Empty: no later skills, or this is
  // not the first.
  std::vector<std::shared_ptr<const Skill>> later_skills;
};

// Prepares `subtasks` for `robot`, which must outlive the skill. Throws core::Error if there is no
// subtask, an option is invalid, a program does not compile or has no success, an object cannot be
// simulated, two of the programs read different inputs, or one of `later` has another number of
// variants.
std::shared_ptr<const Skill> MakeSkill(const robot::RobotModel& robot,
                                       const std::vector<SkillSubtask>& subtasks,
                                       const SkillOptions& options = {},
                                       std::vector<std::shared_ptr<const Skill>> later_skills = {});

// Returns `skill`, without its later skills, in the scenes of `subtasks`; it shares the robot.
// Throws as MakeSkill does.
std::shared_ptr<const Skill> InScenes(const Skill& skill,
                                      const std::vector<SkillSubtask>& subtasks);

}  // namespace simwright::skills
