#pragma once

#include <string>

namespace simwright::nn {

// Returns the path, without links, of the library that serves the matrix products of this program,
// libtorch's among them; empty where libtorch has its own.
std::string BlasLibrary();

}  // namespace simwright::nn
