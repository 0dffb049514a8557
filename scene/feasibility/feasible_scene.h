#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/feasibility/depenetration.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt.h"
#include "sim/settling.h"

namespace simwright::scene {

// Returns the categories that may lie: fruit, and cutlery, which leans in its crock.
std::set<std::string> CategoriesThatMayTopple();

// Returns settling options with a gravity perturbation and a quarter of the friction while the
// perturbation lasts: an object that is held by friction only, such as upright cutlery in its crock
// or an avocado on its side, settles in a pose that is also stable in another engine.
sim::SettlingOptions PerturbedSettlingOptions();

struct FeasibilityOptions {
  DepenetrationOptions projection;
  sim::SettlingOptions settling = PerturbedSettlingOptions();
  // The largest distance in m by which a floating object is lowered onto its support
  // (LowerOntoSupports); 0: it falls. For samples of a model, whose heights have errors of
  // centimetres.
  double lowering = 0.0;
  double tilted = 0.35;  // rad: objects that tilt more are dropped; bowls may lean a little
  // Categories that may topple: they are equally stable lying down.
  std::set<std::string> may_lie = CategoriesThatMayTopple();
  double penetration = 1e-4;  // m, largest penetration of parts in a finished scene
  // The largest number of settling passes: objects that stood on a dropped object settle again, and
  // objects that still move after the first pass come to rest in the second.
  int passes = 6;
  int min_objects = 3;  // fewest free objects of a scene (Pfaff et al., appendix)
  // The projection keeps the relations and tiers of this prompt (AskedRelations) where it can.
  // `named`: flags of the objects that it means, by their index in the scene; empty: the free ones.
  Prompt prompt;
  std::vector<char> named = {};

  bool IsValid(std::string* error) const;
};

// The result of physics on a scene.
struct FeasibleScene {
  // True if there are enough objects, no penetration exceeds the tolerance, and all are stable.
  bool valid = false;
  std::vector<SceneObject> objects;  // at rest; parents as sampled, re-indexed
  std::vector<int> indices;          // of these objects in the input, ascending
  int dropped = 0;                   // objects that fell, toppled or did not come to rest
  double moved = 0.0;                // m, mean displacement of the kept objects
  double penetration = 0.0;          // m, the deepest, of convex parts
  double drift = 0.0;                // m, the largest during the stability check
  bool projected = false;            // Projection::feasible
};

// Resolves the penetrations of a scene, lowers floating objects and lets all settle under gravity;
// drops objects that fell or toppled and, from the second pass on, objects that do not come to
// rest, and settles the others again after a drop. Welded objects keep their poses. Throws
// core::Error for a category without an asset or for invalid options.
FeasibleScene MakeFeasible(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                           const FeasibilityOptions& options = {});

}  // namespace simwright::scene
