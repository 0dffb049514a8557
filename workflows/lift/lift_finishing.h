#pragma once

#include <filesystem>
#include <string>

#include "asset_build/true_size.h"
#include "asset_lift/lift.h"
#include "core/files.h"
#include "core/progress.h"
#include "physics_params/category_resolution.h"
#include "physics_params/stated_physics.h"
#include "workflows/lift/lift.h"

namespace simwright::workflows {

// The settings of the steps that follow each kind of reconstruction: true size, asset, pictures,
// folder.
struct Finishing {
  std::filesystem::path output;
  std::string source;
  physics_params::Resolution category;
  double height = 0.0;           // m; 0: see `metric`
  asset_build::StatedSize size;  // overrides `height`
  physics_params::StatedPhysics stated;
  asset_build::PartBudget budget;
  bool metric = false;  // the mesh is already in metres
  std::uint64_t seed = 1;
};

// Returns the factor from a mesh of arbitrary scale to metres: by `height`, or else to the sampled
// size of the category. Throws core::Error if the mesh has no extent along a side.
double ScaleToMetres(const Finishing& finishing, const core::TriangleMesh& mesh);

// Gives the reconstruction its true size, builds the asset and writes its folder, which `staged`
// then commits. `lift_seconds`: of the reconstruction.
LiftOutcome FinishLift(const Finishing& finishing, double lift_seconds,
                       asset_lift::LiftedMesh lifted, core::StagedFolder* staged,
                       core::Progress* progress);

}  // namespace simwright::workflows
