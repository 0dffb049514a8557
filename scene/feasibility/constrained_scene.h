#pragma once

#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

struct ConstrainedOptions {
  FeasibilityOptions feasibility = PlacingOptions();
  // The stability check with all objects free. Its first pose is the final one, without settling.
  sim::SettlingOptions check = FreeCheckOptions();
  int checks = 6;  // most checks; each drops the objects that disturb others or move themselves

  // Returns options for finding a place: fewer passes and a short stability check, because
  // CheckFree follows.
  static FeasibilityOptions PlacingOptions();
  // Returns a check of two seconds, which ends early as settling's does.
  static sim::SettlingOptions FreeCheckOptions();
};

// The result of physics on a scene of which some objects keep their poses.
struct ConstrainedScene {
  // The kept objects, with the poses of the input, and the others that found a place.
  std::vector<SceneObject> objects;  // without parents
  std::vector<int> indices;          // of these objects in the input, ascending
  int dropped = 0;  // objects without a place, or that would have disturbed kept ones

  // The results of the check (CheckFree). True if every free object but `unstable` stays within
  // `check.stable`.
  bool stable = false;
  double kept_displacement = 0.0;  // m, the largest of the kept ones but `unstable`
  double drift = 0.0;              // m, the largest of the others
  std::vector<int> unstable;       // kept objects that move without the others (input indices)
  double penetration = 0.0;        // m, the deepest, pairs of kept or welded objects excluded
};

// Finds a place for the objects that are not `kept` (N flags): resolves their penetrations, lowers
// and settles them as MakeFeasible does while the kept objects are fixed, and drops those that
// fall, topple, or do not come to rest. Does not check the result. Throws core::Error as
// MakeFeasible does, or if there are not as many flags as objects.
ConstrainedScene PlaceAmong(const std::vector<SceneObject>& objects, const std::vector<char>& kept,
                            const AssetSet& asset_set, const ConstrainedOptions& options = {});

// Checks the scene of PlaceAmong with all objects free but the welded ones: drops objects that
// penetrate too deeply or move by more than `check.stable`, and those that touch, directly or
// through others, a kept object that moves, and checks again. Kept objects that move without any
// others are named and held from then on. `kept`: as given to PlaceAmong, one flag per input
// object.
void CheckFree(const std::vector<char>& kept, const AssetSet& asset_set,
               const ConstrainedOptions& options, ConstrainedScene* scene);

}  // namespace simwright::scene
