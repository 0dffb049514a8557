#pragma once

#include <string>

namespace simwright::nn {

// Returns the path of the library that serves the matrix products of this program, libtorch's among
// them; empty where the program has none.
std::string BlasLibrary();

}  // namespace simwright::nn
