#pragma once

#include "assets/read_mesh.h"

namespace simwright::assets {

// Omits faces with coordinates that are not finite and reports them ("mesh-lost-vertices"). Where
// they are more than a twentieth of all, the file is damaged, and the mesh is left as it is.
void DropBrokenFaces(RawMesh* raw, FindingList* findings);

}  // namespace simwright::assets
