#pragma once

#include "assets/read_mesh.h"

namespace simwright::assets {

// Converts corner colours to what OBJ and every simulator display. If each triangle has one colour
// and few colours differ, they become materials; otherwise a texture of 2 x 2 texels per triangle,
// whose bilinear interpolation equals that of the colours; above about 4 million different
// triangles their mean, rounded to 5 bits per channel. A part with a texture keeps it: one colour
// for the whole part goes into its material, other colours are dropped with a finding.
void ApplyVertexColors(RawMesh* raw, FindingList* findings);

}  // namespace simwright::assets
