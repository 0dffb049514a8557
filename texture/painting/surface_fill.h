#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace simwright::texture {

// Gives each point (m) without a colour one that is diffused from the coloured points around it:
// the mean over the finest cell of a pyramid of grids in space that holds any, interpolated between
// cells, so that it is continuous over the surface. `known` (N) says which of `colors` (N x 3) are
// given; `spacing` (m) is the finest grid's. Does nothing if none is given.
void FillUnknownColors(const std::vector<Eigen::Vector3f>& points,
                       const std::vector<std::uint8_t>& known, float spacing,
                       std::vector<Eigen::Vector3f>* colors);

}  // namespace simwright::texture
