#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace simwright::library {

// The input of a generator. The same options give the same asset.
struct Options {
  std::uint64_t seed = 1;
  std::string name;  // name of the asset; empty: the kind's name
  // Choices in [0, 1) that replace those of the seed, in the generator's order (library/draws.h);
  // may be fewer than the generator makes.
  std::vector<double> draws = {};
  // m, length (longer side), width and height in place of those that the seed samples. Generators
  // keep their own limits, so that the asset's bounds may differ.
  std::optional<Eigen::Vector3d> size = {};
  std::vector<double>* record = nullptr;  // set to all choices unless null
  // If true, masses, densities and joint friction stay unset: for a picture of the asset.
  bool appearance_only = false;
};

}  // namespace simwright::library
