#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// Returns for each closed component (as numbered by EdgeComponents) its winding number with respect
// to the OTHER closed components: 0 if no other encloses it. Components must not intersect. A ray
// from each component counts the faces through which it leaves minus those through which it enters,
// in one pass over the faces. (component count)
std::vector<int> EnclosingWindingNumbers(const core::TriangleMesh& mesh,
                                         const std::vector<int>& component, int count);

// Returns the signed volume of each component; negative for one that faces inward. (component
// count)
std::vector<double> ComponentVolumes(const core::TriangleMesh& mesh,
                                     const std::vector<int>& component, int count);

// Removes the components of a closed mesh that bound no volume: those that face outward within the
// solid, and those that face inward outside of it. Unused vertices are removed, too.
void RemoveBuriedComponents(core::TriangleMesh* mesh);

}  // namespace simwright::geometry
