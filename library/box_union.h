#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::library {

// A box that furniture is put together from. `look` indexes its colour.
struct Plank {
  Eigen::AlignedBox3d box;  // m
  int look = 0;
};

// The closed surface of what the planks fill together; they may touch and cross. Where they share
// an edge alone it is not manifold there. Coordinates closer than 1e-9 are one.
core::TexturedMesh BoxUnion(const std::vector<Plank>& planks,
                            const std::vector<core::Material>& looks);

// Each plank as a convex part, with sharp edges.
std::vector<core::TriangleMesh> PlankParts(const std::vector<Plank>& planks);

}  // namespace simwright::library
