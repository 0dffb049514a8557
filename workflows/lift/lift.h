#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "asset_build/asset_builder.h"
#include "asset_build/true_size.h"
#include "asset_lift/lift.h"
#include "asset_lift/segmentation/salient_network.h"
#include "core/progress.h"
#include "validation/check.h"
#include "workflows/generator/generator_options.h"

namespace simwright::workflows {

// The road from a photo to a shape.
enum class LiftShape {
  kAuto,    // kFitted where it agrees better with the photo, else kFree
  kFitted,  // an object of the library (docs/library.md), articulated or rigid, fitted to the photo
  kFree     // the reconstruction of asset_lift
};

struct LiftRequest {
  std::filesystem::path photo;
  std::string category;  // required
  std::optional<std::filesystem::path> mask;
  std::shared_ptr<asset_lift::SalientNetwork> segmenter;  // null: by colours and contrast
  double height = 0.0;                                    // m; 0: sampled from the category's range
  asset_build::StatedSize size;                           // overrides `height`
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  double elevation_degrees = -1.0;  // negative: estimated
  double fov_degrees = 0.0;         // 0: EXIF or the default
  bool delight = false;             // the texture without the photo's shading (kFree)
  LiftShape shape = LiftShape::kFree;
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFull;
  std::filesystem::path prior;  // the user's TorchScript view prior; empty: the shipped one
  // If given, it makes the mesh in place of the reconstruction: the fields from elevation_degrees
  // to prior are then unused.
  GeneratorOptions generator;
  std::filesystem::path keep_generated;  // also writes the generator's mesh file here; empty: no
  std::uint64_t seed = 1;
  std::filesystem::path output;  // the asset folder
  bool force = false;
};

// Several photos of one object with known cameras.
struct MultiLiftRequest {
  std::vector<std::filesystem::path> photos;
  std::filesystem::path cameras;  // cams.json, see assets/camera_file.h
  std::string category;
  double height = 0.0;           // m; 0: the size that the cameras give
  asset_build::StatedSize size;  // overrides `height`
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFull;
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool force = false;
};

struct LiftOutcome {
  std::filesystem::path folder;
  asset_build::StageSeconds seconds;
  core::Findings findings;
  double silhouette_iou = 0.0;  // NaN for a generator, whose camera is unknown
};

// Reconstructs an asset folder from a photo, and writes beside it matte.png (the matte) and
// lift.png (the photo, the matte, and the mesh from the photo's camera). Throws core::Error if the
// photo cannot be read, the category is unknown, no single object stands out, or the output exists,
// and wherever the generator throws (generator_client.h, generator_command.h); throws
// core::Cancelled.
LiftOutcome LiftToFolder(const LiftRequest& request, core::Progress* progress);

// Reconstructs an asset folder from photos with known cameras. Also throws core::Error if the
// cameras and the photos do not match.
LiftOutcome LiftToFolder(const MultiLiftRequest& request, core::Progress* progress);

// Throws core::Error if the category is unknown, or the output exists and `force` is not set: for
// callers that do long work before a lift.
void RequireLiftable(const std::string& category, const std::filesystem::path& output, bool force);

// Returns the reconstruction prior of a category.
asset_lift::CategoryPrior PriorOf(const physics_params::Category& category);

}  // namespace simwright::workflows
