#include "pipeline/scene_stillness.h"

#include <algorithm>

#include "sim/settling.h"

namespace simwright::pipeline {
namespace {

void TakeFarther(const std::string& name, double moved, FarthestMotion* farthest) {
  if (!farthest->name.empty() && moved <= farthest->moved) return;
  *farthest = {name, moved};
}

FarthestMotion InBullet(const std::vector<scene::DrawnObject>& objects,
                        const std::vector<std::string>& names, const scene::Palette& palette,
                        const sim::StillnessOptions& times) {
  std::vector<sim::SettlingBody> bodies;
  for (const scene::DrawnObject& object : objects) {
    bodies.push_back({&palette.At(object.slot).body, object.world_from_object, object.welded});
  }
  sim::SettlingOptions options;
  options.duration = times.settle;
  options.watch = times.watch;
  options.resting = options.pace = 0.0;  // simulate the full time
  FarthestMotion farthest;
  const std::vector<sim::SettledBody> ends = sim::Settle(bodies, options);
  for (size_t i = 0; i < ends.size(); ++i) {
    if (objects[i].welded) continue;
    TakeFarther(names[i], std::max(ends[i].moved, ends[i].drift), &farthest);
  }
  return farthest;
}

}  // namespace

bool SceneStillness::StillInMujoco() const {
  return warnings.empty() && mujoco.moved <= kStill;
}

bool SceneStillness::StillInBullet() const {
  return bullet.moved <= kStill;
}

SceneStillness WatchScene(const std::filesystem::path& mjcf,
                          const std::vector<scene::DrawnObject>& objects,
                          const std::vector<std::string>& names, const scene::Palette& palette,
                          const sim::StillnessOptions& options) {
  SceneStillness result;
  const sim::MujocoStillness watched = sim::WatchInMujoco(mjcf, options);
  for (const sim::BodyMotion& body : watched.bodies) {
    TakeFarther(body.name, std::max(body.settled, body.drift), &result.mujoco);
  }
  result.things = static_cast<int>(watched.bodies.size());
  result.warnings = watched.warnings;
  result.bullet = InBullet(objects, names, palette, options);
  return result;
}

}  // namespace simwright::pipeline
