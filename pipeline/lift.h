#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asset_lift/lift.h"
#include "core/progress.h"
#include "pipeline/asset_builder.h"
#include "pipeline/check.h"
#include "pipeline/true_size.h"

namespace simwright::pipeline {

struct LiftRequest {
  std::filesystem::path photo;
  std::string category;  // required
  std::optional<std::filesystem::path> mask;
  double height = 0.0;              // m; 0: drawn from the category's range
  StatedSize size;                  // takes the place of `height`
  physics_params::StatedPhysics stated;
  double elevation_degrees = -1.0;  // negative: estimated
  double fov_degrees = 0.0;         // 0: EXIF or the default
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFull;
  std::filesystem::path prior;  // TorchScript view prior of the user's; empty: ours
  std::uint64_t seed = 1;
  std::filesystem::path output;  // the asset's folder
  bool force = false;
};

// Several photos of one thing whose cameras are known.
struct MultiLiftRequest {
  std::vector<std::filesystem::path> photos;
  std::filesystem::path cameras;  // cams.json, see camera_file.h
  std::string category;
  double height = 0.0;  // m; 0: as large as the cameras say
  StatedSize size;      // takes the place of `height`
  physics_params::StatedPhysics stated;
  asset_lift::LiftEffort effort = asset_lift::LiftEffort::kFull;
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool force = false;
};

struct LiftOutcome {
  std::filesystem::path folder;
  StageSeconds seconds;
  core::Findings findings;
  double silhouette_iou = 0.0;
};

// Photo to asset folder, with what the lift saw beside it: matte.png (the cut-out), lift.png
// (photo, cut-out, the mesh from the photo's camera). Throws core::Error: the photo cannot be read,
// the category is unknown, no single object stands out, the output exists; core::Cancelled.
LiftOutcome LiftToFolder(const LiftRequest& request, core::Progress* progress);

// As LiftToFolder, from photos with known cameras. Throws core::Error also where the cameras and
// the photos do not fit together.
LiftOutcome LiftToFolder(const MultiLiftRequest& request, core::Progress* progress);

// The prior of a category for the lift.
asset_lift::CategoryPrior PriorOf(const physics_params::Category& category);

}  // namespace simwright::pipeline
