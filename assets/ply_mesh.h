#pragma once

#include <filesystem>

#include "assets/read_mesh.h"

namespace simwright::assets {

// Reads a PLY: faces (polygons) and triangle strips; vertex colours ("red", "diffuse_red", "r"),
// otherwise face colours; texture coordinates of vertices ("s t", "u v", "texture_u texture_v") or
// of face corners ("texcoord"), with the images that comments name ("TextureFile x.png"). Throws
// core::Error if it is damaged, has no faces, or holds Gaussian splats.
RawMesh ReadPly(const std::filesystem::path& path, FindingList* findings);

}  // namespace simwright::assets
