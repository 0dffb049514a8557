#pragma once

#include "core/mesh.h"
#include "geometry/isosurface.h"

namespace simwright::capture {

struct HullFieldOptions {
  int cells = 128;          // along the mesh's longest side
  double band_cells = 3.0;  // distances are truncated at these
};

// Returns the signed distance to a closed mesh (m, negative inside), at the nodes of a grid that
// exceeds the mesh by two cells. Throws core::Error for a mesh without faces.
geometry::ScalarGrid HullField(const core::TriangleMesh& hull, const HullFieldOptions& options);

}  // namespace simwright::capture
