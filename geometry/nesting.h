#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// For each closed component (as numbered by EdgeComponents), how often the OTHER closed components
// wind round it: 0 for one in the open. Components must not cross each other. A line from each
// component counts the faces that it leaves through, less those that it enters through: one pass
// over the faces. (component count)
std::vector<int> EnclosingWinding(const core::TriangleMesh& mesh, const std::vector<int>& component,
                                  int count);

// The signed volume of each component; its sign says which way it faces. (component count)
std::vector<double> ComponentVolumes(const core::TriangleMesh& mesh,
                                     const std::vector<int>& component, int count);

// Drops the components of a closed mesh that bound nothing: what faces outward within the solid,
// and what faces inward in the open. Vertices that are left over go, too.
void DropBuried(core::TriangleMesh* mesh);

}  // namespace simwright::geometry
