#pragma once

#include <vector>

#include "asset_build/part_budget.h"
#include "assets/urdf_reader.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::importers {

// Returns a link's visuals in its frame, or its collisions if it has none. A visual's colour is its
// own in the URDF, else its file's material times the colour that its texture shows on the triangle
// if the texture has at most 16 colours, or times the texture's mean otherwise. Equal colours share
// one material. The files are read again for their materials.
core::TexturedMesh ColoredVisual(const assets::UrdfLink& link);

// Returns true if `link` has collision shapes of its own: primitives, or meshes that are not
// visuals.
bool HasOwnCollisions(const assets::UrdfLink& link);

// Computes convex, closed, outward-oriented parts, of at most 64 vertices by default, for each
// link, in its frame. The source geometry is the link's collisions if these are primitives or
// separate meshes, else its visuals. Each connected component that is convex becomes its own hull;
// a flat one is thickened to 2 mm; any other becomes a solid and is decomposed so that cavities
// stay open, more coarsely the smaller it is relative to the whole asset. Components shorter than a
// fiftieth of `whole` (the asset's diagonal, m) become hulls, those inside another part are
// removed, and if a link has more than 256 parts only the largest are kept, which is reported. With
// `hulls`, each collision mesh of a link becomes a single hull, as in Bullet and MuJoCo. `budget`
// limits the parts of each link: a component whose hull does not meet its tolerance is decomposed
// within it, whatever its size or thickness, and parts beyond its number are merged where that adds
// the least volume, which is reported ("part-budget"). Components of all links are processed in
// parallel. (links)
std::vector<std::vector<core::TriangleMesh>> ConvexPartsOf(
    const std::vector<assets::UrdfLink>& links, double whole, bool hulls,
    const asset_build::PartBudget& budget, core::Findings* findings);

}  // namespace simwright::importers
