#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <Eigen/Core>

#include "core/error.h"

namespace simwright::python {

namespace nb = nanobind;

// Arguments: C-contiguous arrays of any library with the DLPack or the buffer protocol, in main
// memory. Arrays of another layout or type are converted where a function allows it.
using PointsArgument = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using TrianglesArgument =
    nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using RowsArgument = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Returns a read-only view of `count` x 3 numbers at `data`, which `owner` keeps alive.
template <typename Number>
nb::ndarray<nb::numpy, const Number> View3(const Number* data, std::size_t count,
                                           nb::handle owner) {
  return nb::ndarray<nb::numpy, const Number>(data, {count, 3}, owner);
}

// Returns a read-only view of `shape` numbers at `data`, which `owner` keeps alive.
template <typename Number>
nb::ndarray<nb::numpy, const Number> View(const Number* data, std::initializer_list<size_t> shape,
                                          nb::handle owner) {
  return nb::ndarray<nb::numpy, const Number>(data, shape, owner);
}

// Returns an array that owns `values`, without a copy.
template <typename Number>
nb::ndarray<nb::numpy, Number> Owned(std::vector<Number>&& values,
                                     std::initializer_list<size_t> shape) {
  auto* held = new std::vector<Number>(std::move(values));
  const nb::capsule owner(
      held, [](void* memory) noexcept { delete static_cast<std::vector<Number>*>(memory); });
  return nb::ndarray<nb::numpy, Number>(held->data(), shape, owner);
}

// Returns a new array of `shape` whose numbers are uninitialised, and its memory.
template <typename Number>
std::pair<nb::ndarray<nb::numpy, Number>, Number*> NewArray(std::initializer_list<size_t> shape) {
  std::size_t count = 1;
  for (const size_t side : shape) count *= side;
  auto* memory = new Number[count];
  const nb::capsule owner(memory,
                          [](void* numbers) noexcept { delete[] static_cast<Number*>(numbers); });
  return {nb::ndarray<nb::numpy, Number>(memory, shape, owner), memory};
}

// Throws core::Error, naming the argument, unless it has the shape (rows x columns).
template <typename Array>
void RequireShape(const Array& array, std::size_t rows, std::size_t columns, const char* name) {
  if (array.shape(0) == rows && array.shape(1) == columns) return;
  throw core::Error("has the shape (" + std::to_string(array.shape(0)) + ", " +
                        std::to_string(array.shape(1)) + ")",
                    name, "give (" + std::to_string(rows) + ", " + std::to_string(columns) + ")");
}

}  // namespace simwright::python
