#pragma once

#include <vector>

#include "assets/asset.h"
#include "core/image.h"
#include "core/mesh.h"

namespace simwright::pipeline {

// preview.png: four views of what is seen, and below them of the collision parts, each part in a
// colour of its own.
core::Image AssetPreview(const assets::Asset& asset);

// The asset as it is seen, from a side and above. `size` pixels a side.
core::Image RigidView(const assets::Asset& asset, int size);

// The collision parts as one mesh, a material a part.
core::TexturedMesh PartsInColor(const std::vector<core::TriangleMesh>& parts);

}  // namespace simwright::pipeline
