#pragma once

#include "core/mesh.h"
#include "core/random.h"

namespace simwright::asset_lift {

// A random thing such as stands about in houses, about one unit large, z up: vessels with cavity
// and handles, bodies of revolution, superquadrics and bunches of them, tables, chairs, shelves,
// boxes with doors, lamps; each part with a colour or a procedural texture. What the learned
// priors see beside catalogue meshes: no catalogue has enough forms.
core::TexturedMesh MakeTrainingShape(core::Rng* rng);

}  // namespace simwright::asset_lift
