#pragma once

#include <string>

#include "assets/urdf_reader.h"
#include "tasks/reward/reward_scene.h"

namespace simwright::tasks {

// What a reward program may name of an asset that it calls `name`: its links, and its joints with
// their limits. Floating and planar joints have no single state and are left out.
RewardAsset NamesOf(const std::string& name, const assets::UrdfModel& model);

}  // namespace simwright::tasks
