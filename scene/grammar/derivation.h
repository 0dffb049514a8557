#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// A symbol of a derivation. Each is followed by all that is derived from it.
struct DerivedNode {
  int symbol = -1;   // index into Grammar::symbols()
  int parent = -1;   // index into the derivation; -1: the start
  int branch = -1;   // of the parent's symbol: how it came about, and its pose rule
  int surface = -1;  // the nearest node above that is a surface; -1: none, the world's
  int carrier = -1;  // the nearest object above, welded ones left out; -1: none
  Eigen::Isometry3d world_from_node = Eigen::Isometry3d::Identity();
};

using Derivation = std::vector<DerivedNode>;

const Symbol& SymbolOf(const Grammar& grammar, const DerivedNode& node);

// A derivation by ancestral sampling, poses not drawn. A grammar whose derivations may be without
// end is cut: throws core::Error above 10 000 nodes, naming the grammar.
Derivation Derive(const Grammar& grammar, core::Rng& rng);

// Where what is derived from node `first` ends: an index, one past the last.
int EndOf(const Derivation& derivation, int first);

// Draws the pose of node `first` and of all that is below it, given those above. With `keep`, what
// is below it goes along as it is, and only its own pose is drawn.
void DrawPosesFrom(const Grammar& grammar, int first, bool keep, core::Rng& rng,
                   Derivation* derivation);

// The first of the structure constraints that the derivation does not meet, as an index into
// Grammar::structure(); -1 where it meets all.
int UnmetStructure(const Grammar& grammar, const Derivation& derivation);

}  // namespace simwright::scene
