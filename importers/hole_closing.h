#pragma once

#include <string>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"

namespace simwright::importers {

// Closes the holes of an object that is meant to be closed. `mesh`: z up, any unit. A piece's open
// edges are closed if each of its holes is one of these:
//  - small: less than an eighth of the diagonal across;
//  - the bottom: flat, horizontal, at the lowest height;
//  - flat, anywhere, unless the category is an open vessel or a frame of parts, or is unknown.
// A piece with another hole is a sheet, such as a cup of one wall, and is left as it is. Faces of a
// closed piece that face inward are turned. Findings name `where`: "mesh-holes-closed",
// "mesh-open", "mesh-faces-turned".
void CloseHoles(const physics_params::Category& category, const std::string& where,
                core::TexturedMesh* mesh, core::Findings* findings);

}  // namespace simwright::importers
