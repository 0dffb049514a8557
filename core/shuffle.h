#pragma once

#include <utility>
#include <vector>

#include "core/random.h"

namespace simwright::core {

// Shuffles `items` uniformly (Fisher and Yates 1938).
template <typename T>
void Shuffle(std::vector<T>* items, Rng& rng) {
  for (std::size_t i = items->size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(UniformIndex(rng, static_cast<std::int64_t>(i)));
    std::swap((*items)[i - 1], (*items)[other]);
  }
}

}  // namespace simwright::core
