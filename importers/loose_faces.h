#pragma once

#include <string>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::importers {

// Removes what generators and scans leave beside an object's surface, before its axes and its size
// are known. Everything is measured against the diagonal of the largest connected piece. Findings
// name `where`:
//  - "mesh-fins": small faces that hang on an edge of the surface;
//  - "mesh-coplanar-faces": open pieces that lie on the surface and flicker with it;
//  - "mesh-specks": small pieces in the air or inside the object;
//  - "mesh-inner-shells": closed pieces that no ray from outside reaches (kept, if something in
//    front of them is transparent);
//  - "mesh-floating-parts": larger pieces that touch nothing, which are kept.
// A mesh whose faces hardly share edges is left as it is.
void RemoveLooseFaces(const std::string& where, core::TexturedMesh* mesh, core::Findings* findings);

// Removes inner shells alone: those that closed only when their holes were closed.
void RemoveInnerShells(const std::string& where, core::TexturedMesh* mesh,
                       core::Findings* findings);

}  // namespace simwright::importers
