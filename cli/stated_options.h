#pragma once

#include "asset_build/true_size.h"
#include "cli/command.h"
#include "physics_params/stated_physics.h"

namespace simwright::cli {

// Adds --size, --mass, --density and --friction, which mean the same in lift and import.
void AddStatedOptions(CLI::App* command, asset_build::StatedSize* size,
                      physics_params::StatedPhysics* stated);

}  // namespace simwright::cli
