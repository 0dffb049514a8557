#include "library_fit/example_pool.h"

#include <utility>

#include "core/parallel.h"

namespace simwright::library_fit {

ExamplePool::ExamplePool(const LibraryTrainingOptions& options, std::uint64_t seed,
                         const std::function<void()>& done)
    : options_(options), seed_(seed), examples_(static_cast<size_t>(options.pool)) {
  constexpr int kShares = 100;
  const int size = options.pool;
  for (int share = 0; share < kShares; ++share) {
    const int first = size * share / kShares, last = size * (share + 1) / kShares;
    core::ParallelFor(last - first, [&](int i) {
      examples_[static_cast<size_t>(first + i)] = Make(static_cast<std::uint64_t>(first + i));
    });
    if (done) done();
  }
  made_ = static_cast<std::uint64_t>(size);
}

PriorExample ExamplePool::Make(std::uint64_t number) const {
  core::Rng rng = core::StreamRng(seed_, number);
  const bool has_scenes = options_.scene_example && options_.scene_share > 0.0;
  if (has_scenes && core::Uniform(rng) < options_.scene_share) {
    return options_.scene_example(rng());
  }
  const int kind = PriorExampleKind(&rng);
  return MakePriorExample(kind, 1 + static_cast<std::uint64_t>(core::UniformIndex(
                                        rng, static_cast<std::int64_t>(kHeldOutSeed) - 1)));
}

std::vector<PriorExample> ExamplePool::Render(int count) const {
  std::vector<PriorExample> examples(static_cast<size_t>(count));
  core::ParallelFor(count, [&](int i) {
    examples[static_cast<size_t>(i)] = Make(made_ + static_cast<std::uint64_t>(i));
  });
  return examples;
}

void ExamplePool::Exchange(std::vector<PriorExample> examples) {
  for (PriorExample& example : examples) {
    examples_[static_cast<size_t>(made_ % examples_.size())] = std::move(example);
    ++made_;
  }
}

}  // namespace simwright::library_fit
