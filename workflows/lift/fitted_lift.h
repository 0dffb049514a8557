#pragma once

#include <filesystem>
#include <optional>

#include "asset_lift/lift.h"
#include "core/finding.h"
#include "library_fit/library_fit.h"
#include "validation/check_report.h"
#include "workflows/lift/lift_finishing.h"

namespace simwright::workflows {

// A fit of the library that takes the place of the free form.
struct ChosenFit {
  library_fit::FittedInstance fit;
  library_fit::FitPhoto photo;
  bool articulated = false;
};

// Throws core::Error if the library has no kind of the category, or if the weights of the library
// prior are missing.
void RequireFittable(const Finishing& finishing);

// Fits the library's kinds of the category to the reconstructed photo, and returns the best fit if
// it is chosen: always for kFitted; for kAuto if its outline agrees with the photo about as well as
// that of the free form, `lifted`, and outline and edges together better. Adds a finding that
// states the choice and its reason, unless the library has no kind of the category. Throws
// core::Error for kFitted if the request states what an articulated asset cannot take.
std::optional<ChosenFit> ChooseFit(LiftShape shape, const Finishing& finishing,
                                   const asset_lift::LiftedMesh& lifted, core::Findings* findings,
                                   core::Progress* progress);

// Replaces the mesh and the camera by those of a rigid fit.
void TakeFit(const ChosenFit& chosen, asset_lift::LiftedMesh* lifted);

// Writes the folder of an articulated fit, which `staged` then commits: the asset, preview.png,
// matte.png, and lift.png (the photo, the matte, and the fit from the photo's camera). Throws as
// validation::CheckBeforeKeeping does if the asset fails its checks.
LiftOutcome FinishArticulated(const ChosenFit& chosen, const Finishing& finishing,
                              double lift_seconds, const asset_lift::LiftedMesh& lifted,
                              core::StagedFolder* staged);

// Takes back an articulated fit that failed its check: empties the folder `staging` and replaces
// the finding of the choice by one that says why the free form is taken.
void RejectFit(const validation::CheckFailed& failed, const Finishing& finishing,
               const std::filesystem::path& staging, core::Findings* findings);

}  // namespace simwright::workflows
