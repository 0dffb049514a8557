#pragma once

#include <filesystem>

#include "assets/read_mesh.h"

namespace simwright::assets {

// Reads a glTF 2.0 or GLB: the default scene's nodes with their transforms, all triangle primitives
// (lists, strips, fans, with or without indices), morph targets at their default weights, skins in
// the pose of their joints, COLOR_0, base colours and their textures. y is up. Reads
// KHR_mesh_quantization, KHR_draco_mesh_compression, KHR_texture_transform, KHR_materials_unlit,
// KHR_materials_pbrSpecularGlossiness and EXT_texture_webp; reports other content as findings.
// Throws core::Error for a damaged file, an unsupported required geometry extension (named) or glTF
// 1.
RawMesh ReadGltf(const std::filesystem::path& path, FindingList* findings);

}  // namespace simwright::assets
