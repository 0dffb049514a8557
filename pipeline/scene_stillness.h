#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"
#include "sim/mujoco_stillness.h"

namespace simwright::pipeline {

// What moved in one engine, of which thing.
struct FarthestMotion {
  std::string name;    // empty where nothing is free
  double moved = 0.0;  // m, the most: while settling, or from there while watched
};

// Whether a scene stands still in both engines: settled for 0.25 s, watched for 2.
struct SceneStillness {
  std::string name;  // "scene_00012"
  int things = 0;    // free ones
  FarthestMotion mujoco, bullet;
  std::vector<std::string> warnings;  // MuJoCo's

  bool StillInMujoco() const;  // nothing moved by more than kStill, and no warning
  bool StillInBullet() const;
  bool Still() const { return StillInMujoco() && StillInBullet(); }
};

inline constexpr double kStill = 1e-3;  // m

// Runs the exported file in MuJoCo, and the same objects in Bullet, whose names are those of
// `names` by object. Throws core::Error where MuJoCo refuses the file, or a slot has no asset.
SceneStillness WatchScene(const std::filesystem::path& mjcf,
                          const std::vector<scene::DrawnObject>& objects,
                          const std::vector<std::string>& names, const scene::Palette& palette,
                          const sim::StillnessOptions& options = {});

}  // namespace simwright::pipeline
