#pragma once

#include <cstdint>

#include "core/image.h"
#include "core/mesh.h"
#include "texture/painting/exemplar_generator.h"
#include "texture/painting/texel_map.h"

namespace simwright::texture {

// Textures a mesh with the material of a swatch in its true size (no finer than the texels): three
// pictures as large as the object, quilted from the swatch, are projected along the axes, and each
// texel takes that whose axis is nearest its normal. Along the borders between the three, which a
// noise makes irregular, they are blended without loss of contrast. The colour depends on the place
// in space alone, so that borders of charts do not show. Returns RGB of the map's size; texels
// outside the charts continue them. Throws core::Cancelled.
core::Image BakeExemplar(const core::TriangleMesh& mesh, const TexelMap& map, const Swatch& swatch,
                         std::uint64_t seed);

}  // namespace simwright::texture
