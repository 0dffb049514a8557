#pragma once

#include <cstdint>

namespace simwright::rl {

// The random stream of a rank that corresponds to `stream` of rank 0, which is the one of a process
// that trains alone. Streams of one process are below 2^32.
constexpr std::uint64_t StreamOfRank(std::uint64_t stream, int rank) {
  return (static_cast<std::uint64_t>(rank) << 32) + stream;
}

}  // namespace simwright::rl
