#include "scene/feasibility/feasible_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/log.h"
#include "scene/feasibility/asked_relations.h"
#include "scene/feasibility/lowering.h"
#include "scene/feasibility/narrow_phase.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

std::vector<ProjectedBody> SceneBodies(const std::vector<SceneObject>& objects,
                                       const AssetSet& asset_set) {
  std::vector<ProjectedBody> bodies;
  for (const SceneObject& object : objects) {
    bodies.push_back(
        {&asset_set.At(object.category).parts, object.world_from_object, object.welded});
  }
  return bodies;
}

void Shift(const std::vector<Vector3d>& shifts, std::vector<SceneObject>* objects) {
  for (size_t i = 0; i < objects->size(); ++i) {
    (*objects)[i].world_from_object.pretranslate(shifts[i]);
  }
}

// Resolves the penetrations of the objects, which have these indices in the scene, and keeps the
// relations of the prompt where it can; returns true if no penetration remains.
bool Depenetrate(const AssetSet& asset_set, const FeasibilityOptions& options,
                 const std::vector<int>& indices, std::vector<SceneObject>* objects) {
  std::vector<KeptRelation> relations;
  if (!options.prompt.relations.empty() || !options.prompt.tiers.empty()) {
    std::vector<char> named;
    for (const int index : indices) {
      if (!options.named.empty()) named.push_back(options.named[static_cast<size_t>(index)]);
    }
    relations = AskedRelations(options.prompt, *objects, asset_set.Sizes(), named);
  }
  const Projection projection =
      ResolvePenetrations(SceneBodies(*objects, asset_set), options.projection, relations);
  Shift(projection.shifts, objects);
  return projection.feasible;
}

// Arranges the objects for settling; returns true if no penetration remains.
bool Arrange(const AssetSet& asset_set, const FeasibilityOptions& options,
             const std::vector<int>& indices, std::vector<SceneObject>* objects) {
  const bool apart = Depenetrate(asset_set, options, indices, objects);
  if (options.lowering == 0.0) return apart;
  Shift(LowerOntoSupports(SceneBodies(*objects, asset_set), options.lowering), objects);
  return Depenetrate(asset_set, options, indices, objects);  // for bodies that slid past walls
}

std::vector<sim::SettledBody> SettleObjects(const std::vector<SceneObject>& objects,
                                            const AssetSet& asset_set,
                                            const sim::SettlingOptions& options) {
  std::vector<sim::SettlingBody> bodies;
  for (const SceneObject& object : objects) {
    bodies.push_back(
        {&asset_set.At(object.category).body, object.world_from_object, object.welded});
  }
  return sim::Settle(bodies, options);
}

// Returns the kept objects; the children of dropped ones lose their parent.
std::vector<SceneObject> Kept(const std::vector<SceneObject>& objects,
                              const std::vector<char>& kept) {
  std::vector<int> index(objects.size(), -1);
  std::vector<SceneObject> left;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!kept[i]) continue;
    index[i] = static_cast<int>(left.size());
    left.push_back(objects[i]);
  }
  for (SceneObject& object : left) {
    if (object.parent >= 0) object.parent = index[static_cast<size_t>(object.parent)];
  }
  return left;
}

// Returns the pairs of parts that interpenetrate by more than `depth` (m).
std::vector<NarrowPhasePair> Penetrations(const std::vector<SceneObject>& objects,
                                          const AssetSet& asset_set, double depth) {
  ConvexBodies bodies;
  for (const SceneObject& object : objects) {
    bodies.Add(asset_set.At(object.category).parts, object.world_from_object, object.welded);
  }
  const std::vector<Vector3d> shifts(objects.size(), Vector3d::Zero());
  std::vector<NarrowPhasePair> near;
  bodies.Find(shifts, -depth, &near);
  return near;
}

double DeepestPenetration(const std::vector<SceneObject>& objects, const AssetSet& asset_set) {
  double deepest = 0.0;
  for (const NarrowPhasePair& pair : Penetrations(objects, asset_set, 0.0)) {
    deepest = std::max(deepest, -pair.distance);
  }
  return deepest;
}

// Drops the lighter object of each pair that interpenetrates too deeply, such as cutlery that
// wedges the walls of its crock apart. Returns the number of dropped objects.
int DropWedged(const AssetSet& asset_set, double depth, std::vector<SceneObject>* objects,
               std::vector<int>* indices) {
  std::vector<char> kept(objects->size(), 1);
  const auto mass = [&](int i) {
    const SceneObject& object = (*objects)[static_cast<size_t>(i)];
    return object.welded ? HUGE_VAL : asset_set.At(object.category).body.inertial.mass;
  };
  for (const NarrowPhasePair& pair : Penetrations(*objects, asset_set, depth)) {
    if (!kept[static_cast<size_t>(pair.a)] || !kept[static_cast<size_t>(pair.b)]) continue;
    kept[static_cast<size_t>(mass(pair.a) < mass(pair.b) ? pair.a : pair.b)] = 0;
  }
  std::vector<int> left;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (kept[i]) left.push_back((*indices)[i]);
  }
  *indices = std::move(left);
  *objects = Kept(*objects, kept);
  return static_cast<int>(std::count(kept.begin(), kept.end(), 0));
}

bool IsInValidPose(const sim::SettledBody& settled, const std::string& category,
                   const FeasibilityOptions& options) {
  if (settled.fell) return false;
  return settled.tilted <= options.tilted || options.may_lie.count(category) == 1;
}

}  // namespace

sim::SettlingOptions PerturbedSettlingOptions() {
  sim::SettlingOptions options;
  options.gravity_tilt = 0.05;
  options.settling_friction = 0.25;
  return options;
}

std::set<std::string> CategoriesThatMayTopple() {
  return {"apple",   "apple_2",   "apple_3",   "apple_4", "pear",  "pear_2", "pear_3",
          "avocado", "avocado_2", "avocado_3", "fork",    "knife", "spoon",  "teaspoon"};
}

bool FeasibilityOptions::IsValid(std::string* error) const {
  if (!projection.IsValid(error) || !settling.IsValid(error)) return false;
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(lowering >= 0.0)) return fails("lowering must be 0 m or more");
  if (!(tilted > 0.0)) return fails("tilted must be above 0 rad");
  if (!(penetration > 0.0)) return fails("penetration must be above 0 m");
  if (passes < 1) return fails("passes must be at least 1");
  if (min_objects < 0) return fails("min_objects must be at least 0");
  return true;
}

FeasibleScene MakeFeasible(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                           const FeasibilityOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("feasible scene: " + error);
  if (!options.named.empty() && options.named.size() != objects.size()) {
    throw core::Error("feasible scene: each object is named or not");
  }
  FeasibleScene scene;
  scene.objects = objects;
  scene.indices.resize(objects.size());
  std::iota(scene.indices.begin(), scene.indices.end(), 0);
  scene.projected = Arrange(asset_set, options, scene.indices, &scene.objects);
  for (int pass = 0; pass < options.passes; ++pass) {
    const auto settled = SettleObjects(scene.objects, asset_set, options.settling);
    std::vector<char> kept(settled.size(), 1);
    std::vector<int> left;
    bool any_moving = false;
    scene.drift = 0.0;
    for (size_t i = 0; i < settled.size(); ++i) {
      scene.objects[i].world_from_object = settled[i].world_from_body;
      const bool still_moving = !settled[i].stable && pass == 0 && options.passes > 1;
      kept[i] = IsInValidPose(settled[i], scene.objects[i].category, options) &&
                (settled[i].stable || still_moving);
      if (!kept[i]) continue;
      any_moving = any_moving || still_moving;
      left.push_back(scene.indices[i]);
      scene.drift = std::max(scene.drift, settled[i].drift);
    }
    const auto gone = static_cast<int>(std::count(kept.begin(), kept.end(), 0));
    scene.objects = Kept(scene.objects, kept);
    scene.indices = std::move(left);
    scene.dropped += gone;
    if (gone == 0 && !any_moving) {
      scene.penetration = DeepestPenetration(scene.objects, asset_set);
      if (scene.penetration <= options.penetration || pass + 1 == options.passes) break;
      // Bullet lets the parts of a heap sink in by a fraction of a millimetre. A body that does so
      // again has no room.
      if (pass > 0)
        scene.dropped += DropWedged(asset_set, options.penetration, &scene.objects, &scene.indices);
      Depenetrate(asset_set, options, scene.indices, &scene.objects);
    }
    // The objects near a dropped or moving one have not been checked without it.
    scene.drift = HUGE_VAL;
  }
  scene.penetration = DeepestPenetration(scene.objects, asset_set);
  int free = 0;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].welded) continue;
    ++free;
    const SceneObject& sampled = objects[static_cast<size_t>(scene.indices[i])];
    scene.moved +=
        (scene.objects[i].world_from_object.translation() - sampled.world_from_object.translation())
            .norm();
  }
  if (free > 0) scene.moved /= free;
  scene.valid = free >= options.min_objects && scene.drift <= options.settling.stable &&
                scene.penetration <= options.penetration;
  core::Log(core::LogLevel::kInfo, "scene", scene.valid ? "feasible: " : "not feasible: ", free,
            " free objects, ", scene.dropped, " dropped, penetration ", scene.penetration,
            " m, drift ", scene.drift, " m");
  return scene;
}

}  // namespace simwright::scene
