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

// Photos of one object on a printed mat (`simwright mat`).
struct MatLiftRequest {
  std::vector<std::filesystem::path> photos;
  std::string category;
  // Photos of the same object turned over, on another side: they show the underside. May be empty.
  std::vector<std::filesystem::path> flipped;
  double ruler = 0.1;            // m, the measured length of the mat's printed ruler
  asset_build::StatedSize size;  // overrides the size that the mat gives
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  std::uint64_t seed = 1;
  std::filesystem::path output;  // the asset folder
  bool force = false;
  std::string source = {};       // named in the asset's record; empty: the number of photos
  core::Findings findings = {};  // about the photos: reported with the capture's
};

// Returns whether the photos are to be understood as views of one object on a mat: at least two of
// them show one. Photos that cannot be read count as showing none.
bool ShowMat(const std::vector<std::filesystem::path>& photos);

// Reconstructs an asset folder from photos on a mat, and from those of the flipped object where
// their pose can be trusted: the finding "flipped" gives the agreement in numbers,
// "flipped-left-out" the reason. Writes beside the asset matte.png and lift.png (of the first
// photo) and the files of WriteCaptureReport. Throws core::Error if a photo cannot be read, the
// category is unknown, fewer than four photos show the mat, nothing stands on it, or the output
// exists; core::Cancelled.
LiftOutcome LiftToFolder(const MatLiftRequest& request, core::Progress* progress);

}  // namespace simwright::workflows
