#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "scene/feasibility/pgs_solver.h"
#include "scene/prompt/relation.h"

namespace simwright::scene {

// A relation between two bodies that a projection keeps or establishes.
struct KeptRelation {
  int subject = -1, object = -1;  // indices of bodies
  Relation relation = Relation::kOn;
  PlacedBox subject_box, object_box;  // of the bodies at their initial poses
  // True for a tier of a shelf instead of `relation`: `object` is the shelf and `object_box` the
  // space over the board (Shelves::SpacesOf). It holds if the subject's centre is over the space's
  // footprint and its base at most kContactHeight below the board, but not so near the next board.
  bool tier = false;
};

// Returns true if the relation holds for bodies displaced by `shifts` (N x 3, m, world).
bool HoldsAfter(const KeptRelation& kept, const std::vector<Eigen::Vector3d>& shifts);

// Returns linear constraints on the displacements of the two bodies, a = subject, b = object, that
// imply the relation (the limits of Holds, with a margin of a millimetre): half-spaces of the
// offset between the boxes' centres. A round footprint is replaced by an inscribed polygon,
// nearness by a box, and a relation with several parts (above: a over b or b over a; next to: one
// of four directions; on: the top or the rest height) by the part that is nearest to the initial
// offset.
std::vector<SeparationConstraint> LinearizeRelation(const KeptRelation& kept);

// Returns the direction, world, in which the subject has to leave the object if both collide: up
// for on and above, sideways for the horizontal relations; unset for inside, facing and tiers.
std::optional<Eigen::Vector3d> SeparatingDirection(const KeptRelation& kept);

// Returns true if the relation puts one body into the other's cavity, so that the hull of both says
// nothing about their contact: inside, on the floor of a plate, and between the boards of a shelf.
bool IsInCavity(const KeptRelation& kept);

}  // namespace simwright::scene
