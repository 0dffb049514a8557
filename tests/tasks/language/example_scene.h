#pragma once

#include <string>
#include <vector>

#include "reward/reward_program.h"
#include "tasks/language/scene_description.h"
#include "tasks/reward_names.h"
#include "tasks/subtask_verification.h"

namespace simwright::tasks {

// Returns the names that programs may use for a scene.
inline reward::RewardScene NamesOfScene(const std::vector<NamedModel>& scene) {
  reward::RewardScene names;
  for (const NamedModel& asset : scene) {
    names.assets.push_back(MakeRewardAsset(asset.name, asset.model->model));
  }
  return names;
}

// Returns a verification that reports the compiler's findings and places each asset at the origin.
inline VerifySubtask CompilingVerification(const reward::RewardScene& scene) {
  return [scene](const Task& task, Subtask* subtask) {
    for (const std::string& asset : task.assets) {
      subtask->start.placements.push_back({asset, Eigen::Isometry3d::Identity(), false});
    }
    return reward::CompileReward(subtask->program, &scene).findings;
  };
}

}  // namespace simwright::tasks
