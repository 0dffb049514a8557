#pragma once

#include <string>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::importers {

// Removes the rest of a bottom that is torn into many holes, as scans leave it, so that one flat
// hole remains, which CloseHoles closes. `mesh`: z up. Adds the finding "mesh-torn-bottom".
void RemoveTornBottom(const std::string& where, core::TexturedMesh* mesh, core::Findings* findings);

}  // namespace simwright::importers
