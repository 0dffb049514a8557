#pragma once

#include <string>

#include "assets/urdf_reader.h"
#include "reward/reward_scene.h"

namespace simwright::tasks {

// Returns the names that a reward program may use for an asset called `name`: its links, and its
// joints with their limits. Floating and planar joints have no scalar state and are left out.
reward::RewardAsset MakeRewardAsset(const std::string& name, const assets::UrdfModel& model);

}  // namespace simwright::tasks
