// Breakfast tables: their counts against closed forms, and how things lie about a plate.
#include "scene/grammar/breakfast.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "scene/grammar/scene_draw.h"
#include "tests/scene/geometric_mean.h"

namespace simwright::scene {
namespace {

constexpr int kScenes = 4000;

// Objects of a setting with a plate: it, what is on it, fork, knife, a spoon, a mug.
constexpr double kPlateSetting = 1.0 + 0.6 + 0.7 + 0.8 + 0.4 + 0.8;

double MeanOf(const Grammar& grammar, std::map<std::string, int>* slots) {
  core::Rng rng = core::StreamRng(6, 0);
  double sum = 0.0;
  for (int i = 0; i < kScenes; ++i) {
    const SceneDraw draw = DrawScene(grammar, rng);
    sum += static_cast<double>(draw.objects.size()) - 1.0;
    for (const DrawnObject& object : draw.objects) ++(*slots)[object.slot];
  }
  return sum / kScenes;
}

TEST(BreakfastTable, LowHasTheCountsOfItsGrammar) {
  std::map<std::string, int> slots;
  const double mean = MeanOf(BreakfastTableLow(), &slots);
  const double settings = 2.0 * (0.7 * kPlateSetting + 0.2);
  const double shared = 2.0 * MeanOfGeometric(0.7, 2) + MeanOfGeometric(0.3, 3) +
                        MeanOfGeometric(0.6, 2) + 0.7 * (1.0 + MeanOfGeometric(0.1, 10));
  // Fewer than three objects are one scene in a hundred or so.
  EXPECT_NEAR(mean, settings + shared, 0.4);
  RecordProperty("mean", std::to_string(mean));
  EXPECT_NEAR(slots["utensil_crock"] / static_cast<double>(kScenes), 0.7, 0.04);
  EXPECT_NEAR(slots["mug"] / static_cast<double>(kScenes), 2.0 * 0.7 * 0.8, 0.06);
}

TEST(BreakfastTable, HighHasTheCountsOfItsGrammar) {
  std::map<std::string, int> slots;
  const double mean = MeanOf(BreakfastTableHigh(), &slots);
  const double settings = 6.0 * (0.6 * kPlateSetting + 0.2);
  const double shared = MeanOfGeometric(0.7, 4) + MeanOfGeometric(0.7, 6) +
                        MeanOfGeometric(0.4, 3) + MeanOfGeometric(0.6, 2);
  EXPECT_NEAR(mean, settings + shared, 0.4);
  RecordProperty("mean", std::to_string(mean));
  EXPECT_EQ(slots.count("utensil_crock"), 0u);
}

// Seen from who sits there, forks are left of the plate and knives right, and mugs beyond.
TEST(BreakfastTable, CutleryLiesWhereItBelongs) {
  const Grammar grammar = BreakfastTableHigh();
  core::Rng rng = core::StreamRng(7, 0);
  int forks = 0, knives = 0, mugs = 0;
  for (int i = 0; i < 200; ++i) {
    for (const DrawnObject& object : DrawScene(grammar, rng).objects) {
      const Eigen::Vector3d at = object.world_from_object.translation();
      // Who sits at negative x looks along x; left is y.
      const double facing = at.x() < 0.0 ? 1.0 : -1.0;
      const double pair = 0.45 * std::round(at.y() / 0.45);
      const double left = facing * (at.y() - pair);
      if (object.slot == "fork") {
        ++forks;
        EXPECT_NEAR(left, 0.14, 0.04);
        EXPECT_NEAR(std::abs(at.x()), 0.2, 0.04);
      } else if (object.slot == "knife") {
        ++knives;
        EXPECT_NEAR(left, -0.14, 0.04);
      } else if (object.slot == "mug") {
        ++mugs;
        EXPECT_NEAR(left, -0.15, 0.04);
        EXPECT_NEAR(std::abs(at.x()), 0.07, 0.04);
      }
      EXPECT_LE(std::abs(at.x()), 0.3575);
      EXPECT_LE(std::abs(at.y()), 0.7);
    }
  }
  EXPECT_GT(std::min({forks, knives, mugs}), 400);
}

TEST(BreakfastTable, UtensilsStandInTheirCrock) {
  const Grammar grammar = BreakfastTableLow();
  core::Rng rng = core::StreamRng(8, 0);
  int standing = 0;
  for (int i = 0; i < 300; ++i) {
    const SceneDraw draw = DrawScene(grammar, rng);
    for (const DrawnObject& object : draw.objects) {
      if (object.parent <= 0) continue;
      const DrawnObject& below = draw.objects[static_cast<size_t>(object.parent)];
      if (below.slot != "utensil_crock") continue;
      ++standing;
      EXPECT_NEAR(object.world_from_object.linear().col(0).z(), 1.0, 1e-9);
      const SlotSize& size = SizeOf(DefaultSlotSizes(), object.slot);
      const double foot = object.world_from_object.translation().z() - size.half_size.x();
      const double floor = below.world_from_object.translation().z() +
                           SizeOf(DefaultSlotSizes(), "utensil_crock").rest_height;
      EXPECT_NEAR(foot, floor, 1e-9);
    }
  }
  EXPECT_GT(standing, 500);
}

}  // namespace
}  // namespace simwright::scene
