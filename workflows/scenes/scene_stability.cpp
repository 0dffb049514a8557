#include "workflows/scenes/scene_stability.h"

#include <algorithm>

#include "sim/settling.h"

namespace simwright::workflows {
namespace {

void TakeFarther(const std::string& name, double moved, LargestDisplacement* farthest) {
  if (!farthest->name.empty() && moved <= farthest->moved) return;
  *farthest = {name, moved};
}

LargestDisplacement InBullet(const std::vector<scene::SceneObject>& objects,
                             const std::vector<std::string>& names,
                             const scene::AssetSet& asset_set, const sim::StabilityOptions& times) {
  std::vector<sim::SettlingBody> bodies;
  for (const scene::SceneObject& object : objects) {
    bodies.push_back(
        {&asset_set.At(object.category).body, object.world_from_object, object.welded});
  }
  sim::SettlingOptions options;
  options.duration = times.settle;
  options.watch = times.watch;
  options.rest_tolerance = options.early_stop_factor = 0.0;  // simulate the full time
  LargestDisplacement farthest;
  const std::vector<sim::SettledBody> ends = sim::Settle(bodies, options);
  for (size_t i = 0; i < ends.size(); ++i) {
    if (objects[i].welded) continue;
    TakeFarther(names[i], std::max(ends[i].moved, ends[i].drift), &farthest);
  }
  return farthest;
}

}  // namespace

bool SceneStability::StableInMujoco() const {
  return warnings.empty() && mujoco.moved <= kStabilityTolerance;
}

bool SceneStability::StableInBullet() const {
  return bullet.moved <= kStabilityTolerance;
}

SceneStability CheckSceneStability(const std::filesystem::path& mjcf,
                                   const std::vector<scene::SceneObject>& objects,
                                   const std::vector<std::string>& names,
                                   const scene::AssetSet& asset_set,
                                   const sim::StabilityOptions& options) {
  SceneStability result;
  const sim::MujocoStability watched = sim::CheckStabilityInMujoco(mjcf, options);
  for (const sim::BodyMotion& body : watched.bodies) {
    TakeFarther(body.name, std::max(body.settled, body.drift), &result.mujoco);
  }
  result.objects = static_cast<int>(watched.bodies.size());
  result.warnings = watched.warnings;
  result.bullet = InBullet(objects, names, asset_set, options);
  return result;
}

}  // namespace simwright::workflows
