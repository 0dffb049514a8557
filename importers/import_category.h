#pragma once

#include <string>

#include "physics_params/category_resolution.h"

namespace simwright::importers {

// Returns the category of an object to import: `wanted` if it is not empty, else the one that
// `name` suggests, else the catch-all "object". Understands PartNet-Mobility's model_cat
// ("StorageFurniture") in any letter case. Throws core::Error for an unknown `wanted`.
physics_params::Resolution ImportCategory(const std::string& wanted, const std::string& name);

}  // namespace simwright::importers
