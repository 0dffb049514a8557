#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset_looks/look_rules.h"
#include "assets/articulated_asset.h"
#include "assets/asset.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "core/pbr_look.h"
#include "texture/materials/material_bake.h"
#include "texture/painting/texel_map.h"

namespace simwright::asset_looks {

// One visual mesh ready to be textured: with texture coordinates of its own.
struct TexturedSurface {
  core::TexturedMesh mesh;
  int size = 1024;  // texels per side
  texture::TexelMap map;
  std::vector<int> triangle_slot;               // (M) into AssetSurfaces::slots
  texture::PieceFrames pieces;                  // by slot
  std::vector<texture::PartFrame> slot_frames;  // one per slot of the asset
};

// An asset with what all its variants share.
struct AssetSurfaces {
  std::string name, category;
  std::optional<assets::Asset> rigid;  // one of the two
  core::PbrLook look;                  // of the rigid asset as it is; may be empty
  std::optional<assets::ArticulatedAsset> articulated;
  std::vector<TexturedSurface> surfaces;  // of the rigid asset, or of each link
  std::vector<LookSlot> slots;
  std::vector<double> handle_area;  // m^2, by slot: of what sticks out of a round body
  core::Findings findings;
};

// Reads an asset and prepares its visual meshes: coordinates that overlap or tile are replaced by a
// new atlas (a finding). A link's texture has a share of `size` (texels per side) that follows its
// size, at least 128. Throws core::Error if the folder holds no asset.
AssetSurfaces ReadAssetSurfaces(const std::filesystem::path& folder, int size);

}  // namespace simwright::asset_looks
