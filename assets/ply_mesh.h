#pragma once

#include <filesystem>

#include "assets/read_mesh.h"

namespace simwright::assets {

// Reads a PLY: faces (polygons) and triangle strips; colours of vertices ("red", "diffuse_red",
// "r"), else of faces; texture coordinates of vertices ("s t", "u v", "texture_u texture_v") or of
// faces' corners ("texcoord"), with the pictures that comments name ("TextureFile x.png").
// Throws core::Error where it is damaged, has no faces, or holds Gaussian splats.
RawMesh ReadPly(const std::filesystem::path& path, FindingList* findings);

}  // namespace simwright::assets
