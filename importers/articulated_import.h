#pragma once

#include <filesystem>
#include <string>

#include "asset_build/part_budget.h"
#include "asset_build/true_size.h"
#include "assets/articulated_asset.h"
#include "assets/semantic_model.h"
#include "core/progress.h"
#include "physics_params/stated_physics.h"

namespace simwright::importers {

struct ArticulatedImportOptions {
  std::string name;      // the asset's name
  std::string category;  // empty: from meta.json or asset.json, else from the name, else "object"
  // The height of the whole asset at zero joint positions, m. 0: a folder in PartNet's normalised
  // units is scaled to the bounding-box volume sampled for its category; other files have `unit`
  // metres per file unit.
  double height = 0.0;
  double unit = 1.0;
  bool unit_stated = false;           // by the user: no resulting size is refused
  asset_build::StatedSize size = {};  // the whole asset's; overrides `height`
  physics_params::StatedPhysics stated = {};
  asset_build::PartBudget budget = {};
  std::uint64_t seed = 1;
  std::filesystem::path root = {};  // meshes outside it are not read; empty: ReadUrdf's default
};

// Returns the URDF to import from a folder: GAPartNet's, whose handles are separate links, if there
// is one; else mobility.urdf; else the only URDF. Returns an empty path if there is no URDF or no
// single one.
std::filesystem::path ArticulatedUrdfIn(const std::filesystem::path& folder);

// Returns true if any joint moves once links without shapes are folded away; a model without moving
// joints is a rigid object. Throws core::Error for floating or planar joints and wherever ReadUrdf
// throws.
bool HasMovingJoint(const assets::SemanticModel& source);

// Imports a URDF and the files beside it (docs/formats.md, "Importing articulated assets") as an
// asset at true scale. Links without shapes are folded away, joints follow our conventions,
// collision parts are convex and trimmed until collision-free where they overlap slightly, mass
// follows the category, and joints get friction and damping. The asset's findings list all repairs.
// Throws core::Error wherever ReadUrdf throws, for a model without moving joints or with more than
// 128 of them, for floating or planar joints, for moving links without shapes, and for a model of
// zero or implausible size.
assets::ArticulatedAsset ImportArticulated(const std::filesystem::path& urdf,
                                           const ArticulatedImportOptions& options,
                                           core::Progress* progress);
// Imports a model that has already been read.
assets::ArticulatedAsset ImportArticulated(assets::SemanticModel source,
                                           const ArticulatedImportOptions& options,
                                           core::Progress* progress);

}  // namespace simwright::importers
