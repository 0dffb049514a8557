// Items made ahead are those made when asked for, in the same order; errors reach the caller.
#include "nn/prefetcher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "core/error.h"
#include "nn/compute.h"
#include "nn/noise.h"

namespace simwright::nn {
namespace {

using NumberPrefetcher = Prefetcher<std::unique_ptr<int>>;

std::unique_ptr<int> Boxed(int i) {
  return std::make_unique<int>(i);
}

TEST(Prefetcher, GivesEachItemOnceAndInOrder) {
  for (const bool ahead : {false, true}) {
    std::vector<int> made;
    NumberPrefetcher items(ahead, 3, 9, [&](int i) {
      made.push_back(i);
      return Boxed(i);
    });
    for (int i = 3; i < 9; ++i) EXPECT_EQ(*items.Next(), i) << ahead;
    EXPECT_EQ(made, (std::vector<int>{3, 4, 5, 6, 7, 8})) << ahead;
  }
}

TEST(Prefetcher, MakesOneItemAheadAndNoMore) {
  std::atomic<int> made{0};
  NumberPrefetcher items(true, 0, 100, [&](int i) {
    ++made;
    return Boxed(i);
  });
  items.Next();
  for (int i = 0; i < 2000 && made < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(made, 2);  // the second while the first is used, and none after it
}

TEST(Prefetcher, PassesErrorsOnAtTheirItem) {
  for (const bool ahead : {false, true}) {
    NumberPrefetcher items(ahead, 0, 10, [](int i) {
      if (i == 2) throw core::Error("the stream is damaged", "item 2");
      return Boxed(i);
    });
    EXPECT_EQ(*items.Next(), 0);
    EXPECT_EQ(*items.Next(), 1);
    EXPECT_THROW(items.Next(), core::Error) << ahead;
  }
}

TEST(Prefetcher, EndsWhileAnItemIsBeingMade) {
  std::atomic<bool> begun{false}, ended{false};
  {
    NumberPrefetcher items(true, 0, 10, [&](int i) {
      begun = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      ended = true;
      return Boxed(i);
    });
    while (!begun) std::this_thread::yield();
  }
  EXPECT_TRUE(ended);
}

TEST(Prefetcher, KeepsTheNumbersOfTheThreadThatMadeIt) {
  SetLoopThreads(2);
  const torch::NoGradGuard no_gradient;
  // More numbers than one thread's share of a loop, with functions whose vector form may round
  // differently.
  const auto batches = [](bool ahead) {
    const at::Generator generator = SeededGenerator(5, torch::kCPU, false);
    Prefetcher<torch::Tensor> items(ahead, 0, 3, [&](int) {
      EXPECT_FALSE(torch::GradMode::is_enabled());
      EXPECT_EQ(at::get_num_threads(), 2);
      return torch::log(UniformNumbers({70001}, generator)) + NormalNumbers({70001}, generator);
    });
    return std::vector<torch::Tensor>{items.Next(), items.Next(), items.Next()};
  };
  const std::vector<torch::Tensor> here = batches(false), there = batches(true);
  for (size_t i = 0; i < here.size(); ++i) EXPECT_TRUE(torch::equal(here[i], there[i])) << i;
  EXPECT_FALSE(torch::equal(here[0], here[1]));
}

}  // namespace
}  // namespace simwright::nn
