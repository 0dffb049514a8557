#pragma once

#include <vector>

#include "assets/urdf_reader.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::pipeline {

// What is seen of a link in its frame: its visuals, or what collides where it has none. A colour is
// the visual's own in the URDF, else its file's material times what its texture shows on the
// triangle, where that is at most 16 colours, or times the texture's mean; equal colours are one
// material. The files are read again for their materials.
core::TexturedMesh ColoredVisual(const assets::UrdfLink& link);

// True where `link` has collision shapes of its own: primitives, or meshes that are no visuals.
bool HasOwnCollisions(const assets::UrdfLink& link);

// Convex, closed, outward parts of at most 64 vertices for the matter of each link, in its frame.
// The matter is the link's collisions where these are primitives or meshes of their own, else what
// is seen. Each connected piece that is convex is its own hull; a flat one is given 2 mm; any other
// becomes a solid and is decomposed, so that hollows stay open, the coarser the smaller it is beside
// the whole. Pieces shorter than a fiftieth of `whole` (m, the asset's diagonal) are hulls, those
// inside another part go, and of more than 256 parts of a link the largest are kept; that is
// reported. With `hulls` a link's collision meshes are one hull each, as Bullet and MuJoCo take
// them. Pieces of all links are worked on in parallel. (links)
std::vector<std::vector<core::TriangleMesh>> ConvexPartsOf(
    const std::vector<assets::UrdfLink>& links, double whole, bool hulls,
    core::Findings* findings);

}  // namespace simwright::pipeline
