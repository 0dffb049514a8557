#pragma once

#include <cstdint>

#include "library_fit/prior_example.h"
#include "twin/table_scene.h"

namespace simwright::twin {

// Returns an object of a random table as the library prior sees it in a photo: the crop around its
// visible part, beside and behind other objects, in the photo's resolution, light and colours.
// Instances have seeds from 1 to 1e9 - 1. Deterministic for a seed.
library_fit::PriorExample TableCrop(const TableSceneSources& sources, std::uint64_t seed);

}  // namespace simwright::twin
