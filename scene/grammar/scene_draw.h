#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

struct DrawnObject {
  std::string slot;    // of which asset it is
  std::string symbol;  // of the grammar
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  bool welded = false;
  int parent = -1;  // the object that it stands on or in, furniture too; -1: none
};

struct SceneDraw {
  std::vector<DrawnObject> objects;  // parents before what they carry
  int tries = 0;                     // of which the last succeeded
  int derivations = 0;               // in all tries
  int pose_draws = 0;                // in all tries, redraws among them
};

// A scene of the grammar, before physics: derivations with their poses until one meets what is
// decided by rejection, then each pose that offends the rest drawn anew until none does
// (Metropolis, with the sum of what is missing as energy). The same generator state, the same
// scene. Throws core::Error where options().tries were not enough: what was missed most often, and
// how many derivations or draws that took.
SceneDraw DrawScene(const Grammar& grammar, core::Rng& rng);

}  // namespace simwright::scene
