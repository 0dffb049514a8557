#pragma once

#include <string>

#include "assets/articulated_asset.h"
#include "assets/asset.h"
#include "assets/pbr_look.h"

namespace simwright::assets {

// Return the visuals of an asset as a binary glTF 2.0 (GLB), with its materials and embedded PNG
// textures. The root node turns z up into glTF's y up and has the asset's category, mass (kg) and
// name in its extras. Each link is a node below its parent's, placed at position zero, with the
// joint that moves it in its extras: name, type, axis (link frame), lower, upper (rad or m).
// Normals are those of the previews; tangents are written for materials with a normal map, of the
// texture coordinates as MikkTSpace defines them for smooth corners. Colours become linear.
// Surfaces are double-sided. Throws core::Error for a visual that names a missing texture, or
// beyond 4 GiB.
std::string GlbText(const Asset& asset, const PbrLook& look);
std::string GlbText(const ArticulatedAsset& asset);

}  // namespace simwright::assets
