#pragma once

namespace simwright::core {

// Restarts the program with two environment variables that must be set before OpenMP and OpenBLAS
// start: OMP_WAIT_POLICY=passive, since libtorch's threads otherwise spin while they wait, which
// makes networks several times slower beside other work; and OPENBLAS_CORETYPE=SkylakeX on
// processors with AVX-512, since OpenBLAS 0.3.21 treats those that are newer than itself like ones
// of 2004. Returns if OMP_WAIT_POLICY is set already, or if the restart fails. `argv`: main's.
void RestartWithComputeEnvironment(char** argv);

}  // namespace simwright::core
