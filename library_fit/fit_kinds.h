#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "assets/articulated_asset.h"
#include "core/mesh.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"

namespace simwright::library_fit {

// A kind of the library that can be fitted to a photo.
struct FitKind {
  std::string name;  // "microwave"
  // The rows of the knowledge base that its generator samples from; of light switches there is no
  // row, only the name.
  std::vector<std::string> categories;
  const library::Kind* articulated = nullptr;  // exactly one of the two is set
  const library::RigidKind* rigid = nullptr;
  // The largest share of the first joint's range at which photos usually show it: 1 for laptops,
  // which are photographed open, else 0.
  double opening = 0.0;
};

// Returns the articulated kinds, then the rigid ones, in the order of the library.
const std::vector<FitKind>& FitKinds();
// Returns the kinds of a category, by the name of its row; all kinds for "object". A row without a
// kind has those of its last word: a coffee cup is fitted as a cup.
std::vector<int> KindsOfCategory(const std::string& category);
// Returns the index of the kind of that name, or -1.
int FindFitKind(const std::string& name);

// The parameters of an object of the library.
struct Instance {
  int kind = 0;                   // index into FitKinds()
  std::uint64_t seed = 1;         // of what the other members leave open
  std::vector<double> draws;      // the generator's choices, each in [0, 1) (library/draws.h)
  Eigen::Vector3d size{1, 1, 1};  // m, length, width and height that the generator is given
  double opening = 0.0;           // share of the first moving joint's range, in [0, 1]
};

// Returns the instance that the library generates for a seed, with all its choices. The opening is
// uniform up to the kind's largest.
Instance SampleInstance(int kind, std::uint64_t seed);

// Returns the instance's visible surfaces in the frame of its root: metres, z up, standing on
// z = 0, the front towards -x.
core::TexturedMesh InstanceMesh(const Instance& instance);

// Return the instance as an asset; only for the kinds concerned.
assets::ArticulatedAsset InstanceAsset(const Instance& instance);
library::RigidObject InstanceObject(const Instance& instance);

}  // namespace simwright::library_fit
