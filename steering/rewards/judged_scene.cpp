#include "steering/rewards/judged_scene.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "core/error.h"
#include "scene/metrics/penetration.h"
#include "sim/settling.h"

namespace simwright::steering {
namespace {

sim::SettlingOptions WatchOptions(const JudgingOptions& options) {
  sim::SettlingOptions watch;
  watch.duration = options.duration;
  watch.watch = 0.0;
  watch.time_step = options.time_step;
  watch.rest_tolerance = 0.0;  // no early end, and nothing is removed
  return watch;
}

}  // namespace

int JudgedScene::FeasibleCount(bool welded) const {
  int count = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    if ((welded || !objects[i].welded) && IsFeasible(i)) ++count;
  }
  return count;
}

bool JudgingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(penetration >= 0.0)) return fails("penetration must be at least 0 m");
  if (!(duration > 0.0) || duration > 60.0) return fails("duration must be above 0, at most 60 s");
  if (!(displacement > 0.0)) return fails("displacement must be above 0 m");
  if (!(rotation > 0.0)) return fails("rotation must be above 0 rad");
  if (!(time_step > 0.0) || time_step > 0.02) {
    return fails("time_step must be above 0 and at most 0.02 s");
  }
  return true;
}

JudgedScene Judge(const std::vector<scene::SceneObject>& objects, const scene::AssetSet& asset_set,
                  const JudgingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("judging a scene: " + error);
  JudgedScene judged{objects, std::vector<char>(objects.size(), 0),
                     std::vector<char>(objects.size(), 0)};
  for (const scene::PenetratingPair& pair :
       scene::PenetratingPairs(objects, asset_set, options.penetration)) {
    for (const size_t i : {pair.a, pair.b}) judged.penetrating[i] = !objects[i].welded;
  }
  std::vector<sim::SettlingBody> bodies;
  std::vector<size_t> numbers;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (judged.penetrating[i]) continue;
    bodies.push_back(
        {&asset_set.At(objects[i].category).body, objects[i].world_from_object, objects[i].welded});
    numbers.push_back(i);
  }
  const std::vector<sim::SettledBody> ends = sim::Settle(bodies, WatchOptions(options));
  for (size_t k = 0; k < ends.size(); ++k) {
    if (bodies[k].fixed) continue;
    const Eigen::AngleAxisd turn(ends[k].world_from_body.linear() *
                                 bodies[k].world_from_body.linear().transpose());
    const bool still =
        ends[k].moved <= options.displacement && std::abs(turn.angle()) <= options.rotation;
    judged.unstable[numbers[k]] = !still;
  }
  return judged;
}

}  // namespace simwright::steering
