#pragma once

#include <cstdint>
#include <string>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/knowledge_base.h"

namespace simwright::importers {

// A mesh file of whose scale the user states nothing, so that it is taken for one in metres.
struct FileScale {
  std::string place;       // of findings
  double unit = 1.0;       // m per unit of the file, as already applied
  std::uint64_t seed = 1;  // of a sampled size
};

// Scales a mesh whose size nobody stated and which no object of its category can have
// (physics_params::IsAbsurdSize): by the first unit that gives a usual size ("unit-guessed"), else
// to the size sampled for the category ("size-drawn"), both warnings. Of a mesh that stays as it
// is, reports a longest side of exactly 1 or 2, which is rather a generator's box than a length in
// metres ("size-normalized").
void ScaleAbsurdMesh(const physics_params::Category& category, const FileScale& scale,
                     core::TriangleMesh* mesh, core::Findings* findings);

// Scales a mesh of arbitrary scale to the size sampled for its category.
core::Finding ScaleToCategory(const physics_params::Category& category, const FileScale& scale,
                              core::TriangleMesh* mesh);

}  // namespace simwright::importers
