#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "assets/asset.h"
#include "core/progress.h"
#include "geometry/convex_decomposition.h"
#include "geometry/solid.h"
#include "physics_params/category_resolution.h"
#include "physics_params/stated_physics.h"

namespace simwright::pipeline {

struct BuildRequest {
  std::string name;                     // made file-safe
  std::string source;                   // file name of the photo or mesh
  physics_params::Resolution category;  // of RequireCategory or ResolveCategory; not null
  physics_params::StatedPhysics stated;  // by the user; wins
  std::uint64_t seed = 1;
  geometry::SolidOptions solid;
  geometry::DecompositionOptions decomposition;
  // Closed, convex, at most decomposition.max_hull_vertices vertices, in the mesh's frame: what
  // collides, taken as it is. Empty: convex decomposition finds them.
  std::vector<core::TriangleMesh> parts;
};

// Wall-clock seconds by stage, for people and benchmarks; kept out of the asset, whose bytes
// depend on its input and seed alone.
using StageSeconds = std::map<std::string, double>;

struct BuiltAsset {
  assets::Asset asset;
  StageSeconds seconds;
};

// From a mesh as it is seen (metres, true size, z up as it stood) to an asset that holds in
// simulation: closed solid, mass and inertia, collision parts, rest pose, link frame.
// The rest pose is the given one where the thing can stand so, else its most probable stable pose
// that holds in a drop. Throws core::Error where no solid can be made of the mesh.
BuiltAsset BuildAsset(const core::TexturedMesh& visual, const BuildRequest& request,
                      core::Progress* progress);

}  // namespace simwright::pipeline
