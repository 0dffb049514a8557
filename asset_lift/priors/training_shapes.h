#pragma once

#include "core/mesh.h"
#include "core/random.h"

namespace simwright::asset_lift {

// Returns a random household object, about one unit large, z up: vessels with a hollow and handles,
// solids of revolution, superquadrics and bunches of them, tables, chairs, shelves, boxes with
// doors, lamps; each part has a colour or a procedural texture. The learned priors train on them
// beside catalogue meshes, because no catalogue has enough shapes.
core::TexturedMesh MakeTrainingShape(core::Rng* rng);

}  // namespace simwright::asset_lift
