#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "asset_build/true_size.h"
#include "core/finding.h"
#include "core/progress.h"
#include "physics_params/stated_physics.h"
#include "workflows/lift/lift.h"

namespace simwright::workflows {

// Photos of one object on a table, with unknown cameras and without a mat.
struct TableLiftRequest {
  std::vector<std::filesystem::path> photos;
  std::string category;
  double height = 0.0;           // m; 0: sampled from the category's range
  asset_build::StatedSize size;  // overrides `height`
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  std::uint64_t seed = 1;
  std::filesystem::path output;  // the asset folder
  bool force = false;
  std::string source = {};       // named in the asset's record; empty: the number of photos
  core::Findings findings = {};  // about the photos: reported with the capture's
};

// Reconstructs an asset folder from photos of one object, and writes beside the asset matte.png and
// lift.png (of the first photo) and the files of WriteCaptureReport, in metres. Throws core::Error
// if a photo cannot be read, the category is unknown or the output exists, and wherever
// capture::CaptureOnTable throws; core::Cancelled.
LiftOutcome LiftToFolder(const TableLiftRequest& request, core::Progress* progress);

// Returns whether the first photos show one scene from different places, so that they may be meant
// as photos of one object. Photos that cannot be read count as showing nothing.
bool ShowOneScene(const std::vector<std::filesystem::path>& photos);

}  // namespace simwright::workflows
