#include "library/draws.h"

#include <algorithm>

namespace simwright::library {

double Draws::Next() {
  double value = core::Uniform(rng_);
  if (record_.size() < given_.size()) {
    value = std::clamp(given_[record_.size()], 0.0, 1.0 - 0x1.0p-53);
  }
  record_.push_back(value);
  return value;
}

}  // namespace simwright::library
