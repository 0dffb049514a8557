#pragma once

#include <string>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::importers {

// Returns the standard deviation of random displacements of a surface's vertices, in its unit; 0
// for a smooth one. Each vertex's offset from the mean of its neighbours along its normal is
// compared with its neighbours': noise makes them opposite, curvature and edges make them alike.
double SurfaceNoise(const core::TriangleMesh& mesh);

// Adds the warning "mesh-noise" if noise makes the smallest side uncertain by more than 0.8 %.
void WarnOfNoise(const std::string& where, const core::TriangleMesh& mesh,
                 core::Findings* findings);

}  // namespace simwright::importers
