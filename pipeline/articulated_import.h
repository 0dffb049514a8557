#pragma once

#include <filesystem>
#include <string>

#include "assets/articulated_asset.h"
#include "assets/semantic_model.h"
#include "core/progress.h"
#include "physics_params/stated_physics.h"
#include "pipeline/true_size.h"

namespace simwright::pipeline {

struct ArticulatedImportOptions {
  std::string name;      // of the asset
  std::string category;  // empty: by meta.json or asset.json, else by the name, else "object"
  // m, of the whole as it stands, joints at zero. 0: folders with PartNet's normalised units get
  // the volume of the box sampled for their category; others are `unit` metres a unit.
  double height = 0.0;
  double unit = 1.0;
  bool unit_stated = false;  // by the user: any size that comes out is meant
  StatedSize size = {};      // of the whole, its longest side; takes the place of `height`
  physics_params::StatedPhysics stated = {};
  std::uint64_t seed = 1;
  std::filesystem::path root = {};  // no mesh is read from outside it; empty: as ReadUrdf has it
};

// The URDF to import of a folder: GAPartNet's where there is one, in which handles are links of
// their own, else mobility.urdf, else the only one. Empty where there is none or no one of them.
std::filesystem::path ArticulatedUrdfIn(const std::filesystem::path& folder);

// Whether any joint moves, once links without shapes are folded away: what has none is a rigid
// thing. Throws core::Error: what ReadUrdf throws, floating or planar joints.
bool HasMovingJoint(const assets::SemanticModel& source);

// A URDF with what lies beside it (docs/formats.md, "Importing articulated things") as an asset at
// true scale: links without shapes folded away, joints by our conventions, collision parts that
// are convex and clear each other where they overlapped by little, mass by category, friction and
// damping. What was mended is in its findings. Throws core::Error: what ReadUrdf throws, no joint
// that moves, more than 128 of them, floating or planar joints, links that move but have no
// shapes, a thing without extent or of an absurd one.
assets::ArticulatedAsset ImportArticulated(const std::filesystem::path& urdf,
                                           const ArticulatedImportOptions& options,
                                           core::Progress* progress);
// The same of what was read already.
assets::ArticulatedAsset ImportArticulated(assets::SemanticModel source,
                                           const ArticulatedImportOptions& options,
                                           core::Progress* progress);

}  // namespace simwright::pipeline
