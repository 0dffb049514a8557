#pragma once

#include "assets/read_mesh.h"

namespace simwright::assets {

// Turns colours at corners into what OBJ and every simulator show. Where all triangles are of one
// colour each and few differ, they become materials; else a texture of 2 x 2 texels a triangle,
// whose bilinear interpolation is the colours' own; above some 4 million different triangles their
// mean, rounded to 5 bits a channel. A part with a texture of its own keeps that: one colour for
// all of it goes into its material, others are left out with a finding.
void ApplyVertexColors(RawMesh* raw, FindingList* findings);

}  // namespace simwright::assets
