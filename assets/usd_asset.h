#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assets/articulated_asset.h"
#include "assets/asset.h"
#include "assets/pbr_look.h"
#include "core/image.h"

namespace simwright::assets {

// A layer of OpenUSD and the images that it refers to.
struct UsdFiles {
  struct ImageFile {
    std::string path;                    // relative to the layer: "./textures/mug_000.png"
    const core::Image* image = nullptr;  // of the asset or its look, which must outlive this
  };
  std::string text;  // USDA
  std::vector<ImageFile> images;
};

// Return the asset as a component of a scene: metres, z up, UsdPhysics. Names that USD forbids are
// made valid; the original is the display name. Bodies have mass, centre of mass, principal moments
// and axes; each convex part is a hidden mesh that collides as its hull; pictures use
// UsdPreviewSurface. Numbers of UsdPhysics are floats, with 9 digits.
//
// An articulated asset has its links side by side, placed at position zero, and joints whose axis
// is the x axis of their frames. Limits of revolute joints are in degrees. Damping is that of a
// drive without stiffness whose target velocity is 0. The articulation's root is the asset's prim;
// a fixed asset has a joint that holds its root link to the world. Limits of velocity, friction of
// joints and joints that follow others of their kind (HasUsdMimic) use Newton's schemas. Floating
// and planar joints, other mimic relations, and limits of effort are left out; a body of mass 0
// means to USD that its mass is to be computed, unless a fixed joint makes it a part of its
// parent's.
//
// Throw core::Error if a material names an image that is missing, or a joint a link that is missing
// or comes later than its child.
UsdFiles UsdOf(const Asset& asset, const PbrLook& look);
UsdFiles UsdOf(const ArticulatedAsset& asset);

// Writes the layer as `file` into an existing folder, and its images beside it. Throws core::Error
// if it cannot.
void WriteUsd(const UsdFiles& files, const std::filesystem::path& folder, const std::string& file);

}  // namespace simwright::assets
