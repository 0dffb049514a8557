#pragma once

#include <cstdint>
#include <memory>

#include "scene/asset_set/asset_set.h"
#include "steering/rewards/scene_reward.h"
#include "workflows/scenes/certify_task.h"

namespace simwright::workflows {

// The scenes that a task asks for.
enum class Solvability {
  kSolvable,         // 1 if there is a plan for the robot, else 0
  kHardButSolvable,  // 0 without a plan, else 0.5 and half the difficulty
};

// Returns the reward of scenes for a robot's task: whether there is a plan among the scene's
// feasible objects (certificate::PlannedDifficulty, without replay). The robot is the Panda, at the
// base that certificates choose. `asset_set` must outlive the reward.
std::unique_ptr<steering::SceneReward> SolvableReward(const CertifyTask& task,
                                                      Solvability solvability,
                                                      const scene::AssetSet& asset_set,
                                                      std::uint64_t seed);

}  // namespace simwright::workflows
