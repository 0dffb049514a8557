#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "texture/image_generator.h"
#include "texture/painting/perceptual_distance.h"

namespace simwright::workflows {

struct TextureRequest {
  std::filesystem::path asset;     // a folder, rigid or articulated
  std::string prompt;              // words; may be empty
  std::filesystem::path exemplar;  // a picture of the look that is wanted; may be empty
  std::filesystem::path like;      // the folder of an asset of that look; may be empty
  // Paints the views for the words or the picture. Null: materials by rule for words, and patches
  // of the picture.
  std::shared_ptr<texture::ImageGenerator> generator;
  int variants = 1;
  int size = 1024;            // texels per side of the (largest) texture
  bool as_materials = false;  // one folder with all variants' maps, for rigid assets
  std::filesystem::path output = "textured";
  std::uint64_t seed = 1;  // of the first variant; the others count up
  bool force = false;      // replaces existing output

  // Returns false, with the reason, for values out of range or more than one source of the look.
  bool IsValid(std::string* error) const;
};

struct TextureVariant {
  std::string name;
  std::filesystem::path folder;
  std::uint64_t seed = 1;
  std::vector<std::string> materials;  // "red: ceramic", one per kind of surface
  double seconds = 0.0;
  double unseen_share = 0.0;               // of the texels, that no view painted
  texture::PerceptualDistance from_asset;  // of a view of the variant to one of the asset
  texture::PerceptualDistance from_first;  // to the first variant
};

struct TextureReport {
  std::string asset;
  std::vector<TextureVariant> variants;
  std::filesystem::path sheet;  // the asset and its variants side by side
  int texels = 0;               // that the surface covers, in all textures
  double preparation = 0.0;     // s, of what the variants share
  bool interrupted = false;     // Ctrl-C ended the work; `variants` are those that are written
  core::Findings findings;
};

// Textures an asset. Each variant becomes a folder NAME_NNN in `output` (one folder NAME with
// as_materials), with the geometry, mass and collision parts of the asset. After Ctrl-C the
// finished folders and their sheet are kept and the report is `interrupted`; without any, or with
// as_materials, nothing is written and core::Cancelled is thrown. Throws core::Error for a
// wrong request, an existing output, and what readers, generators and writers throw.
TextureReport TextureAsset(const TextureRequest& request, core::Progress* progress);

std::string TextureTable(const TextureReport& report);
std::string TextureReportJson(const TextureReport& report);

}  // namespace simwright::workflows
