#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "asset_build/part_budget.h"
#include "assets/asset.h"
#include "core/progress.h"
#include "geometry/convex_decomposition.h"
#include "geometry/solid.h"
#include "physics_params/category_resolution.h"
#include "physics_params/stated_physics.h"

namespace simwright::asset_build {

struct BuildRequest {
  std::string name;                      // converted to a safe file name
  std::string source;                    // the photo's or mesh's file name
  physics_params::Resolution category;   // from RequireCategory or ResolveCategory; not null
  physics_params::StatedPhysics stated;  // by the user; takes precedence
  // The standard error of the logarithm of the volume, if the shape was measured at true size: an
  // imported mesh, or many photos with a scale. The mass then follows from material and volume.
  std::optional<double> volume_error;
  std::uint64_t seed = 1;
  geometry::SolidOptions solid;
  geometry::DecompositionOptions decomposition;
  PartBudget budget;  // by the user; takes precedence over `decomposition`
  // The collision parts, used unchanged: closed, convex, at most decomposition.max_hull_vertices
  // vertices each, in the mesh's frame. Empty: computed by convex decomposition.
  std::vector<core::TriangleMesh> parts;
};

// The wall-clock seconds of each stage, for people and benchmarks. They are not part of the asset,
// whose bytes depend only on its input and seed.
using StageSeconds = std::map<std::string, double>;

struct BuiltAsset {
  assets::Asset asset;
  StageSeconds seconds;
};

// Builds a simulation-ready asset from a visual mesh (metres, true size, z up in the original
// pose): a closed solid, mass and inertia, collision parts, rest pose and link frame. The rest pose
// is the given one if it is statically stable, else the most probable stable pose that passes a
// drop test. Throws core::Error if no solid can be made from the mesh.
BuiltAsset BuildAsset(const core::TexturedMesh& visual, const BuildRequest& request,
                      core::Progress* progress);

}  // namespace simwright::asset_build
