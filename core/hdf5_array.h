#pragma once

#include <cstddef>
#include <vector>

namespace simwright::core {

// An array of any shape, with the last index contiguous.
template <typename T>
struct Hdf5Array {
  std::vector<std::size_t> shape;
  std::vector<T> values;  // as many as the product of `shape`
};

}  // namespace simwright::core
