#pragma once

#include "cli/command.h"
#include "physics_params/stated_physics.h"
#include "pipeline/true_size.h"

namespace simwright::cli {

// Adds --size, --mass, --density and --friction, which mean the same in lift and import.
void AddStatedOptions(CLI::App* command, pipeline::StatedSize* size,
                      physics_params::StatedPhysics* stated);

}  // namespace simwright::cli
