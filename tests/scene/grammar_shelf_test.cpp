// Shelves: their counts against closed forms, and where things stand.
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "scene/grammar/living_room_shelf.h"
#include "scene/grammar/pantry_shelf.h"
#include "scene/grammar/scene_draw.h"
#include "tests/scene/geometric_mean.h"

namespace simwright::scene {
namespace {

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
  EXPECT_EQ(heights, (std::set<int>{170, 2870, 5470, 8170}));
}

// Without what is thrown away: of a lower board 0.7 of a setting's things and 0.2 of a large game's
// stack, of the top one 0.8 and 0.1.
double ExpectedOnALivingRoomShelf() {
  // 1 / (1 - 0.3) to a stack, but for its limit, which cuts a thousandth.
  const double stack = 1.0 / 0.7;
  const double lower = 0.3 * stack + 0.1 + 2.0 * MeanOfGeometric(0.7, 6) + 0.2 +
                       MeanOfGeometric(0.7, 3) * stack + 0.2 + 0.2 + 0.2 * 1.75;
  const double top = MeanOfGeometric(0.8, 2) + 0.2 + 0.3 * stack + 0.1;
  return 3.0 * (0.7 * lower + 0.2 * stack) + 0.8 * top + 0.1 * stack;
}

TEST(LivingRoomShelf, HasTheCountsOfItsGrammar) {
  const Grammar grammar = LivingRoomShelf();
  core::Rng rng = core::StreamRng(3, 0);
  constexpr int kScenes = 4000;
  std::map<size_t, int> by_count;
  double sum = 0.0, derivations = 0.0;
  for (int i = 0; i < kScenes; ++i) {
    const SceneDraw draw = DrawScene(grammar, rng);
    ++by_count[draw.objects.size() - 1];
    sum += static_cast<double>(draw.objects.size() - 1);
    derivations += draw.derivations;
  }
  EXPECT_GE(by_count.begin()->first, 3u);
  EXPECT_LE(by_count.rbegin()->first, 22u);
  // With those of fewer than three objects, which are thrown away, the mean is the grammar's: they
  // have between 0 and 2. The mean's deviation is 0.06.
  const double accepted = kScenes / derivations;
  const double expected = ExpectedOnALivingRoomShelf();
  EXPECT_LE(accepted * sum / kScenes, expected + 0.2);
  EXPECT_GE(accepted * sum / kScenes + 2.0 * (1.0 - accepted), expected - 0.2);
  RecordProperty("mean", std::to_string(sum / kScenes));
  RecordProperty("grammar", std::to_string(expected));
}

TEST(LivingRoomShelf, GamesAreStackedAndFoodIsOnPlates) {
  const Grammar grammar = LivingRoomShelf();
  core::Rng rng = core::StreamRng(5, 0);
  int stacked = 0, on_plates = 0;
  for (int i = 0; i < 2000; ++i) {
    const SceneDraw draw = DrawScene(grammar, rng);
    for (const DrawnObject& object : draw.objects) {
      if (object.parent <= 0) continue;
      const DrawnObject& below = draw.objects[static_cast<size_t>(object.parent)];
      const Eigen::Vector3d way =
          below.world_from_object.inverse() * object.world_from_object.translation();
      const SlotSize& size = SizeOf(DefaultSlotSizes(), below.slot);
      if (below.slot == "plate") {
        ++on_plates;
        EXPECT_NEAR(way.z(), size.rest_height, 1e-12);
      } else {
        ++stacked;
        EXPECT_EQ(below.slot, object.slot);
        EXPECT_NEAR(way.z(), size.height, 1e-12);
      }
      EXPECT_LT(way.head<2>().norm(), 1e-12);
    }
  }
  EXPECT_GT(stacked, 500);
  EXPECT_GT(on_plates, 300);
}

}  // namespace
}  // namespace simwright::scene
