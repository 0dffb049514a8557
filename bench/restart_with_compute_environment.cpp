// Runs a benchmark in the environment in which `simwright` runs.
#include "core/compute_environment.h"

namespace {

__attribute__((constructor)) void Restart(int, char** argv, char**) {
  simwright::core::RestartWithComputeEnvironment(argv);
}

}  // namespace
