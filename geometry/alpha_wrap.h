#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct AlphaWrapOptions {
  double alpha_ratio = 1.0 / 50.0;    // of the diagonal: narrower gaps are closed
  double offset_ratio = 1.0 / 600.0;  // of the diagonal: offset outside the surface
};

// Computes CGAL's alpha wrap (Portaneri et al. 2022): always closed, manifold and oriented outward,
// but strictly outside the input by the offset, and it closes narrow hollows. It is MakeSolid's
// last resort. Throws core::Error for a mesh without faces or extent.
core::TriangleMesh AlphaWrap(const core::TriangleMesh& mesh, const AlphaWrapOptions& options = {});

}  // namespace simwright::geometry
