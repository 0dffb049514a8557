#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "library_fit/library_training.h"
#include "library_fit/prior_example.h"

namespace simwright::library_fit {

// The pictures on which the library prior trains, kept in memory and exchanged gradually, since
// rendering one takes longer than a step of the network on it.
class ExamplePool {
 public:
  // Renders the first `options.pool` pictures. Deterministic for a seed, regardless of the threads.
  // `done` is called after each of some hundred shares of the work. `options` must outlive the
  // pool.
  ExamplePool(const LibraryTrainingOptions& options, std::uint64_t seed,
              const std::function<void()>& done);

  // Renders the next `count` pictures, without changing the pool; may run in another thread.
  std::vector<PriorExample> Render(int count) const;
  // Replaces the oldest pictures.
  void Exchange(std::vector<PriorExample> examples);

  int size() const { return static_cast<int>(examples_.size()); }
  const PriorExample& at(int index) const { return examples_[static_cast<size_t>(index)]; }

 private:
  PriorExample Make(std::uint64_t number) const;

  const LibraryTrainingOptions& options_;
  std::uint64_t seed_;
  std::uint64_t made_ = 0;
  std::vector<PriorExample> examples_;
};

}  // namespace simwright::library_fit
