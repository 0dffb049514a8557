// The statistics of a dataset, from attempts made by hand.
#include <gtest/gtest.h>

#include "workflows/scenes/scene_generation.h"

namespace simwright::workflows {
namespace {

TEST(SceneStatistics, CountsWhatBecameOfAttempts) {
  //  sampled, kept, dropped, projected, valid, moved, penetration, drift
  const std::vector<scene::SceneAttempt> attempts = {
      {10, 9, 1, true, true, 0.002, 5e-5, 2e-4},
      {6, 6, 0, true, true, 0.004, 8e-5, 1e-4},
      {4, 2, 2, true, false, 0.001, 0.0, 0.0},      // at rest, but too few
      {8, 8, 0, true, false, 0.001, 3e-4, 1e-4},    // interpenetrating
      {8, 7, 1, false, false, 0.001, 1e-5, 2e-3}};  // moves
  const SceneStatistics statistics = StatisticsOf(attempts);
  EXPECT_EQ(statistics.attempts, 5);
  EXPECT_EQ(statistics.scenes, 2);
  EXPECT_EQ(statistics.too_few, 1);
  EXPECT_DOUBLE_EQ(statistics.yield, 0.4);
  EXPECT_DOUBLE_EQ(statistics.mean_objects, 7.5);
  EXPECT_DOUBLE_EQ(statistics.mean_drawn, 7.2);
  EXPECT_EQ(statistics.most_objects, 9);
  EXPECT_DOUBLE_EQ(statistics.dropped, 0.5);
  EXPECT_DOUBLE_EQ(statistics.moved, 0.003);
  EXPECT_DOUBLE_EQ(statistics.penetration, 8e-5);
  EXPECT_DOUBLE_EQ(statistics.drift, 2e-4);
  EXPECT_EQ(statistics.drawn_counts[8], 2);
  EXPECT_EQ(statistics.scene_counts[9], 1);
  EXPECT_NE(StatisticsTable(statistics).find("1 more are collision-free and stable"),
            std::string::npos);
  EXPECT_EQ(StatisticsOf({}).yield, 0.0);
}

}  // namespace
}  // namespace simwright::workflows
