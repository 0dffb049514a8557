#pragma once

#include "assets/read_mesh.h"

namespace simwright::assets {

// Gives materials whose texture or maps no face can show, because the file states no texture
// coordinates, the mean colour of their texture, and removes textures that are then unused. Adds
// the finding "texture-without-uvs" for each material with such faces.
void DropTexturesWithoutUvs(RawMesh* raw, FindingList* findings);

}  // namespace simwright::assets
