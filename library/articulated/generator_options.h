#pragma once

#include <cstdint>
#include <string>

namespace simwright::library {

// The input of a generator. The same options give the same asset.
struct Options {
  std::uint64_t seed = 1;
  std::string name;  // name of the asset; empty: the kind's name
};

}  // namespace simwright::library
