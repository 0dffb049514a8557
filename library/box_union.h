#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::library {

// A box from which furniture is assembled. `look` indexes its colour.
struct FurnitureBox {
  Eigen::AlignedBox3d box;  // m
  int look = 0;
};

// Returns the closed surface of the union of the planks; they may touch and overlap. The surface is
// non-manifold where planks share only an edge. Coordinates closer than 1e-9 are merged.
core::TexturedMesh BoxUnion(const std::vector<FurnitureBox>& planks,
                            const std::vector<core::Material>& looks);

// Returns each plank as a convex part with sharp edges.
std::vector<core::TriangleMesh> FurnitureBoxParts(const std::vector<FurnitureBox>& planks);

}  // namespace simwright::library
