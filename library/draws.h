#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/random.h"

namespace simwright::library {

// The random numbers from which a generator makes its choices, in the order in which it asks for
// them. They are the parameters of an instance: those that decide its shape and look are recorded,
// and can be given instead of sampled. Each given number replaces the sampled one in the same
// place, so that the others stay as the seed determines them.
class Draws {
 public:
  Draws() = default;
  // `given`: in [0, 1), may be shorter or longer than the generator's choices.
  explicit Draws(core::Rng rng, std::vector<double> given = {})
      : rng_(rng), given_(std::move(given)) {}

  // Returns the next choice in [0, 1).
  double Next();
  // Returns the generator of what no picture shows, friction for example: its numbers are neither
  // recorded nor given.
  core::Rng& unseen() { return rng_; }
  // Returns the choices so far.
  const std::vector<double>& record() const { return record_; }

 private:
  core::Rng rng_;
  std::vector<double> given_, record_;
};

// Return what the functions of core/random.h of the same names return.
inline double Uniform(Draws& draws) {
  return draws.Next();
}
inline double Uniform(Draws& draws, double low, double high) {
  return low + (high - low) * draws.Next();
}
inline std::int64_t UniformIndex(Draws& draws, std::int64_t count) {
  return static_cast<std::int64_t>(draws.Next() * static_cast<double>(count));
}

}  // namespace simwright::library
