#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Core>

#include "rl/policy.h"
#include "skills/observation.h"
#include "tasks/task.h"
#include "transfer/transfer_task.h"
#include "workflows/skills/skill_run.h"

namespace simwright::transfer {

// Returns a run of `task` in which the scripted expert acts.
inline workflows::SkillRun ExpertRun(const tasks::TaskSet& set, const std::string& task,
                                     const std::filesystem::path& folder) {
  workflows::SkillRun run;
  run.folder = folder;
  run.set = workflows::ChooseTasks(set, {task}, "tasks.json");
  run.proved_grasps = false;
  run.options.action = skills::ActionSpace::kGuided;
  return run;
}

// Returns a network whose action is zero: with guided actions, the scripted expert.
inline rl::Policy ExpertPolicy(const TransferTask& task) {
  const skills::Skill& skill = *task.skills().front().evaluated;
  const int inputs = skills::Observer(skill, skill.variants.front()).size();
  rl::Mlp::Layer layer;
  layer.weights = Eigen::MatrixXf::Zero(inputs, 7);
  layer.bias = Eigen::RowVectorXf::Zero(7);
  return {rl::ObservationScale(inputs), rl::Mlp({layer}, rl::Activation::kElu),
          Eigen::RowVectorXf::Constant(7, 0.05f)};
}

}  // namespace simwright::transfer
