#pragma once

#include <string>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::steering {

// A scene with the result of physics for each object.
struct JudgedScene {
  std::vector<scene::SceneObject> objects;
  // One flag per object; welded objects have none set. Empty: the scene was not judged.
  std::vector<char> penetrating;  // it penetrates another object too deeply
  std::vector<char> unstable;     // it moves, or leaves the scene, when physics is switched on

  bool IsJudged() const { return penetrating.size() == objects.size(); }
  // Returns true if the object is neither penetrating nor unstable. Requires a judged scene.
  bool IsFeasible(size_t object) const { return !penetrating[object] && !unstable[object]; }
  // Returns the number of feasible objects; with `welded`, furniture counts, too. Requires a judged
  // scene.
  int FeasibleCount(bool welded) const;
};

// The thresholds are those of Pfaff et al. (Steerable Scene Generation, masks of the search).
struct JudgingOptions {
  double penetration = 1e-3;   // m: deeper pairs of parts make both objects penetrating
  double duration = 0.1;       // s of simulation of the objects that do not penetrate
  double displacement = 1e-3;  // m, of the farthest point: above it, an object is unstable
  double rotation = 1e-2;      // rad: above it, an object is unstable
  double time_step = 1e-3;     // s

  bool IsValid(std::string* error) const;
};

// Judges each object of a scene: whether it penetrates another one (pairs of welded objects
// excluded), and whether it moves once those that penetrate are removed. Thread-safe. Throws
// core::Error for invalid options, a category without an asset, or a pose that is not finite.
JudgedScene Judge(const std::vector<scene::SceneObject>& objects, const scene::AssetSet& asset_set,
                  const JudgingOptions& options = {});

}  // namespace simwright::steering
