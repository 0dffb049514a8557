// Shelves: their counts against closed forms, and where things stand.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scene/grammar/pantry_shelf.h"
#include "scene/grammar/scene_draw.h"

namespace simwright::scene {
namespace {

// The mean of k = 0 .. last with P(k) ~ (1 - p)^k p.
double MeanOfGeometric(double p, int last) {
  double sum = 0.0, total = 0.0;
  for (int k = 0; k <= last; ++k) {
    sum += k * std::pow(1.0 - p, k);
    total += std::pow(1.0 - p, k);
  }
  return sum / total;
}

TEST(PantryShelf, HasTheCountsOfItsGrammar) {
  const Grammar grammar = PantryShelf();
  core::Rng rng = core::StreamRng(2, 0);
  constexpr int kScenes = 2000;
  double sum = 0.0, bowls = 0.0;
  size_t most = 0;
  for (int i = 0; i < kScenes; ++i) {
    const SceneDraw draw = DrawScene(grammar, rng);
    sum += static_cast<double>(draw.objects.size());
    most = std::max(most, draw.objects.size());
    for (const DrawnObject& object : draw.objects) bowls += object.slot == "bowl";
  }
  // The shelf, twelve kinds on four boards and a bowl. At most 61 cuts off what is three deviations
  // (8.4) above the mean.
  const double mean = 1.0 + 48.0 * MeanOfGeometric(0.6, 10) + 0.2;
  EXPECT_NEAR(sum / kScenes, mean, 0.6);
  EXPECT_NEAR(bowls / kScenes, 0.2, 0.03);
  EXPECT_LE(most, 61u);
  EXPECT_GT(most, 52u);
}

TEST(PantryShelf, ThingsStandOnItsBoardsInsideOfIt) {
  const Grammar grammar = PantryShelf();
  core::Rng rng = core::StreamRng(4, 0);
  std::set<int> heights;
  for (int i = 0; i < 200; ++i) {
    for (const DrawnObject& object : DrawScene(grammar, rng).objects) {
      if (object.welded) {
        EXPECT_EQ(object.slot, "shelf_pantry");
        continue;
      }
      EXPECT_EQ(object.parent, 0);
      const Eigen::Vector3d at = object.world_from_object.translation();
      const double radius = SizeOf(DefaultSlotSizes(), object.slot).Radius();
      EXPECT_LE(std::abs(at.x()), 0.15 - radius);
      EXPECT_LE(std::abs(at.y()), 0.3 - radius);
      heights.insert(static_cast<int>(std::lround(1e4 * at.z())));
    }
  }
  EXPECT_EQ(heights, (std::set<int>{15, 2715, 5315, 8015}));
}

}  // namespace
}  // namespace simwright::scene
