#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

struct SceneObject {
  std::string category;  // category of its asset
  std::string symbol;    // symbol of the grammar
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  bool welded = false;
  int parent = -1;  // the object that supports or contains it, furniture included; -1: none
};

struct SceneSample {
  std::vector<SceneObject> objects;  // parents before their children
  int tries = 0;                     // the last of which succeeded
  int derivations = 0;               // in all tries
  int pose_draws = 0;                // in all tries, resampling included
};

// Samples a scene of the grammar, before physics: derivations with poses until one satisfies the
// constraints that are enforced by rejection, then the violating poses are resampled until none
// violates the others (Metropolis, with the sum of the violations as energy). Deterministic in the
// state of the generator. Throws core::Error if options().tries did not suffice, with the most
// frequent violation and the numbers of derivations and pose samples.
SceneSample SampleGrammar(const Grammar& grammar, core::Rng& rng);

}  // namespace simwright::scene
