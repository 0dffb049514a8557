#pragma once

#include "asset_build/part_budget.h"
#include "asset_build/true_size.h"
#include "cli/command.h"
#include "physics_params/stated_physics.h"

namespace simwright::cli {

// Adds --material and --size-class, which choose a variant of a category.
void AddVariantOptions(CLI::App* command, physics_params::VariantChoice* variant);

// Adds --size, --mass, --density, --friction and the options of variants, which mean the same in
// lift and import.
void AddStatedOptions(CLI::App* command, asset_build::StatedSize* size,
                      physics_params::StatedPhysics* stated);

// Adds --max-parts, --max-vertices, --max-faces and --part-tolerance, the limits of collision
// parts, which mean the same in lift and import.
void AddPartOptions(CLI::App* command, asset_build::PartBudget* budget);

}  // namespace simwright::cli
