#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct AlphaWrapOptions {
  double alpha_ratio = 1.0 / 50.0;    // of the diagonal: gaps narrower than this close
  double offset_ratio = 1.0 / 600.0;  // of the diagonal: how far outside the surface it lies
};

// CGAL's alpha wrapping (Portaneri et al. 2022): always closed, manifold and oriented outward, but
// strictly outside the input by the offset and blind to narrow hollows. The last resort of
// MakeSolid. Throws core::Error for a mesh without faces or extent.
core::TriangleMesh AlphaWrap(const core::TriangleMesh& mesh, const AlphaWrapOptions& options = {});

}  // namespace simwright::geometry
