#pragma once

#include <string>

#include "physics_params/category_resolution.h"

namespace simwright::pipeline {

// The category of a thing to import: `wanted` where it is not empty, else what `name` says of it,
// else the catch-all "object". PartNet-Mobility's model_cat ("StorageFurniture") is understood,
// in any case. Throws core::Error for a `wanted` that is not known.
physics_params::Resolution ImportCategory(const std::string& wanted, const std::string& name);

}  // namespace simwright::pipeline
