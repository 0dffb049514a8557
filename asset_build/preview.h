#pragma once

#include <vector>

#include "assets/asset.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/pbr_look.h"

namespace simwright::asset_build {

// Renders preview.png: four views of the visual, and below them of the collision parts, each in its
// own colour. `look` (may be null): the reflection of the visual's materials.
core::Image AssetPreview(const assets::Asset& asset, const core::PbrLook* look = nullptr);

// Renders the asset's visual from a side and above. `size` pixels a side.
core::Image RigidView(const assets::Asset& asset, int size);

// Returns the collision parts as one mesh with one material per part.
core::TexturedMesh ColoredParts(const std::vector<core::TriangleMesh>& parts);

}  // namespace simwright::asset_build
