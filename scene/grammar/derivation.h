#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// A node of a derivation. Each node is followed by its descendants.
struct DerivedNode {
  int symbol = -1;   // index into Grammar::symbols()
  int parent = -1;   // index into the derivation; -1: the start
  int branch = -1;   // branch of the parent's symbol: gives the pose rule
  int surface = -1;  // the nearest ancestor that is a surface; -1: the world
  int carrier = -1;  // the nearest free ancestor object; -1: none
  Eigen::Isometry3d world_from_node = Eigen::Isometry3d::Identity();
};

using Derivation = std::vector<DerivedNode>;

const Symbol& SymbolOf(const Grammar& grammar, const DerivedNode& node);

// Returns a derivation by ancestral sampling, without poses. Throws core::Error, naming the
// grammar, above 10 000 nodes, which bounds grammars with infinite derivations.
Derivation Derive(const Grammar& grammar, core::Rng& rng);

// Returns the end of the subtree of node `first`: the index one past its last node.
int EndOf(const Derivation& derivation, int first);

// Samples the poses of node `first` and its descendants, given those of its ancestors. With `keep`,
// only the pose of `first` is sampled and its descendants move rigidly with it.
void SamplePosesFrom(const Grammar& grammar, int first, bool keep, core::Rng& rng,
                     Derivation* derivation);

// Returns the index into Grammar::structure() of the first constraint that the derivation violates;
// -1 if it satisfies all.
int FirstViolatedStructure(const Grammar& grammar, const Derivation& derivation);

}  // namespace simwright::scene
