#pragma once

#include <string>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::importers {

// Splits faces at vertices of their neighbours that lie on their open edges (T-junctions), so that
// both share all edges and no crack is left. Reports the number of split faces at `where`
// ("mesh-cracks-joined").
void JoinTJunctions(const std::string& where, core::TexturedMesh* mesh, core::Findings* findings);

}  // namespace simwright::importers
