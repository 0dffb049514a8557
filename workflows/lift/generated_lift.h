#pragma once

#include "workflows/lift/lift.h"

namespace simwright::workflows {

// Makes an asset folder from a photo by `request.generator`: the object is cut out, the generator
// makes a mesh of it, and the mesh is imported like a mesh file (workflows/import/import.h), at the
// size that is stated or sampled for the category. Beside the asset, writes matte.png (the picture
// that the generator got) and lift.png (the photo, this picture, and the mesh from its front: -y,
// 15 degrees above). Throws as LiftToFolder does.
LiftOutcome LiftByGenerator(const LiftRequest& request, core::Progress* progress);

}  // namespace simwright::workflows
