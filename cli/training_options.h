#pragma once

#include <cstdint>

#include "cli/command.h"

namespace simwright::cli {

// Adds the flags of every command that trains: --envs, --steps, --minutes, --target, --episodes and
// --imitate. The initial value of each variable is the flag's default; the variables must outlive
// `command`.
void AddTrainingOptions(CLI::App* command, int* environments, std::int64_t* samples,
                        double* minutes, double* target, int* episodes, std::int64_t* imitated);

}  // namespace simwright::cli
