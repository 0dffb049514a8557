#pragma once

#include <cstdint>

#include "cli/command.h"

namespace simwright::cli {

// Flags of every command that trains: --envs, --steps, --minutes, --target, --episodes, --imitate.
// Each of the numbers is its own default, and must outlive `command`.
void AddTrainingOptions(CLI::App* command, int* environments, std::int64_t* samples,
                        double* minutes, double* target, int* episodes, std::int64_t* imitated);

}  // namespace simwright::cli
