#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "asset_looks/asset_surfaces.h"
#include "core/json.h"
#include "texture/materials/material_bake.h"

namespace simwright::asset_looks {

// Returns the asset with the maps of one variant as its textures: one material per visual mesh.
assets::Asset TexturedRigid(const AssetSurfaces& asset, const texture::MaterialMaps& maps,
                            const std::string& name);
assets::ArticulatedAsset TexturedArticulated(const AssetSurfaces& asset,
                                             const std::vector<texture::MaterialMaps>& maps,
                                             const std::string& name);

// Writes a variant into the existing `folder`: all files of the asset, with the maps as its look
// and `record` as "texture" in asset.json. Other files of `source` and other members of its
// asset.json are copied. Geometry, mass and collision parts are those of the asset. Returns a view
// of it.
core::Image WriteVariant(const AssetSurfaces& asset, const std::vector<texture::MaterialMaps>& maps,
                         const std::string& name, const core::OrderedJson& record,
                         const std::filesystem::path& source, const std::filesystem::path& folder);

// Writes the maps of variant `index` into the folder of a rigid asset, appearance_NNN_*.png, and
// returns its entry for AddAppearances.
core::OrderedJson WriteAppearance(const texture::MaterialMaps& maps, std::size_t index,
                                  const core::OrderedJson& record,
                                  const std::filesystem::path& folder);
// Adds "appearances" to asset.json; the first of the `entries` is the asset's own look.
void AddAppearances(const std::vector<core::OrderedJson>& entries,
                    const std::filesystem::path& folder);

// Returns a view of the asset as it is, or of a rigid asset with `maps`, of the size of
// WriteVariant's.
core::Image ViewOf(const AssetSurfaces& asset, const texture::MaterialMaps* maps = nullptr);

}  // namespace simwright::asset_looks
