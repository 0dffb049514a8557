#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"
#include "sim/mujoco_stability.h"

namespace simwright::workflows {

// The object that moved farthest in one engine.
struct LargestDisplacement {
  std::string name;    // empty if there is no free object
  double moved = 0.0;  // maximum displacement while settling or, from there, in the check, m
};

// The stability of a scene in both engines: settled for 0.25 s, then checked for 2 s.
struct SceneStability {
  std::string name;  // "scene_00012"
  int objects = 0;   // the number of free objects
  LargestDisplacement mujoco, bullet;
  std::vector<std::string> warnings;  // MuJoCo's

  bool StableInMujoco() const;  // no displacement above kStabilityTolerance, and no warning
  bool StableInBullet() const;
  bool Still() const { return StableInMujoco() && StableInBullet(); }
};

inline constexpr double kStabilityTolerance = 1e-3;  // m

// Simulates the exported file in MuJoCo and the same objects in Bullet. `names` are the objects'
// names, by object. Throws core::Error if MuJoCo rejects the file or a category has no asset.
SceneStability CheckSceneStability(const std::filesystem::path& mjcf,
                                   const std::vector<scene::SceneObject>& objects,
                                   const std::vector<std::string>& names,
                                   const scene::AssetSet& asset_set,
                                   const sim::StabilityOptions& options = {});

}  // namespace simwright::workflows
