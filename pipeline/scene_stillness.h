#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"
#include "sim/mujoco_stillness.h"

namespace simwright::pipeline {

// The object that moved farthest in one engine.
struct FarthestMotion {
  std::string name;    // empty if there is no free object
  double moved = 0.0;  // maximum displacement while settling or, from there, in the check, m
};

// The stability of a scene in both engines: settled for 0.25 s, then checked for 2 s.
struct SceneStillness {
  std::string name;  // "scene_00012"
  int things = 0;    // the number of free objects
  FarthestMotion mujoco, bullet;
  std::vector<std::string> warnings;  // MuJoCo's

  bool StillInMujoco() const;  // no displacement above kStill, and no warning
  bool StillInBullet() const;
  bool Still() const { return StillInMujoco() && StillInBullet(); }
};

inline constexpr double kStill = 1e-3;  // m

// Simulates the exported file in MuJoCo and the same objects in Bullet. `names` are the objects'
// names, by object. Throws core::Error if MuJoCo rejects the file or a category has no asset.
SceneStillness WatchScene(const std::filesystem::path& mjcf,
                          const std::vector<scene::DrawnObject>& objects,
                          const std::vector<std::string>& names, const scene::Palette& palette,
                          const sim::StillnessOptions& options = {});

}  // namespace simwright::pipeline
