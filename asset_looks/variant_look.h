#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_looks/asset_surfaces.h"
#include "core/finding.h"
#include "texture/materials/look_words.h"
#include "texture/materials/material_bake.h"

namespace simwright::asset_looks {

// The materials of one variant of an asset.
struct VariantLook {
  std::vector<texture::SurfaceMaterial> materials;  // first one per slot, then those of regions
  // By slot, the index of the material of a vessel's inside and of a round body's handle, or -1.
  std::vector<int> inside, handle;
  std::vector<bool> is_main;  // by slot: what words about the whole mean
};

// Returns the words of a prompt, read with the asset's parts and category, and reports those that
// say nothing, and parts that the asset does not have.
texture::LookWords ReadAssetWords(const std::string& prompt, const AssetSurfaces& asset,
                                  core::Findings* findings);

// Returns the materials of a variant: by rule for each slot, changed by the words. Surfaces whose
// names in the files are equal get one material. The same seed gives the same look.
VariantLook MakeVariantLook(const AssetSurfaces& asset, const texture::LookWords& words,
                            std::uint64_t seed);

// Returns the plan for one of the asset's surfaces.
texture::MaterialPlan PlanOf(const TexturedSurface& surface, const VariantLook& look);

}  // namespace simwright::asset_looks
