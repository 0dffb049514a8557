// Breakfast tables: counts against closed forms, distances between objects, and the layout around a
// plate.
#include "scene/scene_types/breakfast.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/scene/geometric_mean.h"
#include "tests/scene/sampled_objects.h"

namespace simwright::scene {
namespace {

constexpr double kHalfX = 0.3575, kHalfY = 0.7, kMargin = 0.1;  // m

const std::vector<SceneSample>& GrammarBreakfastDraws(bool high) {
  static const auto sample = [](const Grammar& grammar) {
    std::vector<SceneSample> samples;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      core::Rng rng = core::StreamRng(6, i);
      samples.push_back(SampleGrammar(grammar, rng));
    }
    return samples;
  };
  static const std::vector<SceneSample> highs = sample(BreakfastTableHigh());
  static const std::vector<SceneSample> lows = sample(BreakfastTableLow());
  return high ? highs : lows;
}

// Returns the keep-out radius of a shared object; less than 0 for objects of a setting.
double SharedRadius(const std::string& symbol) {
  const std::map<std::string, double> radii = {{"shared_plate", 0.11},
                                               {"shared_bowl", 0.08},
                                               {"cereal_box", 0.15},
                                               {"jug", 0.06},
                                               {"utensil_crock", 0.06}};
  const auto found = radii.find(symbol);
  return found == radii.end() ? -1.0 : found->second;
}

bool HasShared(const SceneSample& sample) {
  return std::any_of(sample.objects.begin(), sample.objects.end(),
                     [](const SceneObject& o) { return SharedRadius(o.symbol) >= 0.0; });
}

TEST(BreakfastTable, KeepsSettingsAndSharedThingsApartAndInsideTheRim) {
  for (const bool high : {false, true}) {
    int pairs = 0;
    for (const SceneSample& sample : GrammarBreakfastDraws(high)) {
      for (const SceneObject& one : sample.objects) {
        if (!IsBase(sample, one)) continue;
        ASSERT_LE(std::abs(PlaceOf(one).x()), kHalfX - kMargin + 1e-12);
        ASSERT_LE(std::abs(PlaceOf(one).y()), kHalfY - kMargin + 1e-12);
        ASSERT_NEAR(PlaceOf(one).z(), 0.75, 1e-12);
        const double radius = SharedRadius(one.symbol);
        if (radius < 0.0) continue;
        for (const SceneObject& other : sample.objects) {
          if (!IsBase(sample, other) || SharedRadius(other.symbol) >= 0.0) continue;
          ASSERT_GE(Across(one, other), radius - 1e-12) << one.symbol << " " << other.symbol;
          ++pairs;
        }
      }
    }
    EXPECT_GT(pairs, 3000);
  }
}

// P(Z <= z) of a standard normal.
double Normal(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

// Returns the probability that all of n items beside a setting are inside the margin: they lie 0.05
// m towards the rim with deviation 0.01 m, at most 0.2575 m from the middle, while the setting is
// at 0.2 m with deviation 0.02 m.
double AllInside(int n) {
  double sum = 0.0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double z = -6.0 + 12.0 * (i + 0.5) / kSteps;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI);
    const double left = 0.0075 - 0.02 * z;
    if (0.02 * z > 0.0575) continue;  // the setting itself
    sum += density * std::pow(Normal(left / 0.01), n) * 12.0 / kSteps;
  }
  return sum;
}

// Without shared objects, settings of the middle pair are rejected only for items beyond the margin
// of the rim, so that the remaining share of each kind is known.
TEST(BreakfastTable, TheMiddlePairHasItsClosedForm) {
  const double fork = 0.7 * 0.2 * AllInside(1) + 0.56 * AllInside(2);
  const double plate = 0.6 * (0.06 * AllInside(0) + 0.24 * AllInside(1) + fork);
  const double bowl = 0.2 * (2.0 / 3.0 * AllInside(0) + 1.0 / 3.0 * AllInside(1));
  const double total = plate + bowl + 0.2;
  int scenes = 0, plates = 0, bowls = 0, forks = 0;
  for (const SceneSample& sample : GrammarBreakfastDraws(true)) {
    if (HasShared(sample)) continue;
    ++scenes;
    bool middle = false;
    for (const SceneObject& object : sample.objects) {
      const bool own = object.symbol == "own_plate" || object.symbol == "own_bowl";
      // Objects of a setting follow its dish.
      if (own) middle = std::abs(PlaceOf(object).y()) <= 0.08;
      if (!middle) continue;
      plates += object.symbol == "own_plate";
      bowls += object.symbol == "own_bowl";
      forks += object.symbol == "fork";
    }
  }
  ASSERT_GT(scenes, 800);
  // Four standard deviations.
  const auto expect = [&](int count, double share) {
    EXPECT_NEAR(count / (2.0 * scenes), share,
                4.0 * std::sqrt(share * (1.0 - share) / (2.0 * scenes)));
  };
  expect(plates, plate / total);
  expect(bowls, bowl / total);
  expect(forks, 0.6 * fork / total);
}

// The contents of a dish do not affect rejection: they are as frequent as published.
TEST(BreakfastTable, DishesHoldWhatIsPublished) {
  const std::map<std::string, std::map<std::string, double>> published = {
      {"own_plate", {{"toast", 0.2}, {"apple", 0.1}, {"pear", 0.1}, {"bowl", 0.2}, {"", 0.4}}},
      {"own_bowl", {{"toast", 0.1}, {"apple", 0.1}, {"pear", 0.1}, {"", 0.7}}},
      {"shared_plate", {{"toast", 0.5}, {"apple", 0.25}, {"pear", 0.25}}},
      {"shared_bowl", {{"toast", 0.2}, {"apple", 0.4}, {"pear", 0.4}}},
      {"toast", {{"toast", 0.25}, {"", 0.75}}}};
  std::map<std::string, std::map<std::string, int>> seen;
  std::map<std::string, int> dishes;
  for (const SceneSample& sample : GrammarBreakfastDraws(true)) {
    for (size_t i = 0; i < sample.objects.size(); ++i) {
      const std::string& dish = sample.objects[i].symbol;
      if (published.count(dish) == 0) continue;
      ++dishes[dish];
      ++seen[dish][CarriedBy(sample, i)];
    }
  }
  for (const auto& [dish, shares] : published) {
    ASSERT_GT(dishes[dish], 200) << dish;
    EXPECT_EQ(seen[dish].size(), shares.size()) << dish;
    for (const auto& [held, share] : shares) {
      EXPECT_NEAR(seen[dish][held] / static_cast<double>(dishes[dish]), share,
                  4.0 * std::sqrt(share * (1.0 - share) / dishes[dish]))
          << dish << " with " << held;
    }
  }
}

TEST(BreakfastTable, ACrockHoldsAGeometricNumberOfUtensils) {
  double crocks = 0.0, utensils = 0.0;
  for (const SceneSample& sample : GrammarBreakfastDraws(false)) {
    for (const SceneObject& object : sample.objects) {
      crocks += object.category == "utensil_crock";
      utensils += object.parent > 0 && ParentOf(sample, object).category == "utensil_crock";
    }
  }
  // The deviation of one is 3.0.
  EXPECT_NEAR(utensils / crocks, MeanOfGeometric(0.1, 10), 4.0 * 3.0 / std::sqrt(crocks));
  EXPECT_LT(crocks, 0.7 * 3000);  // crocks are rejected, too
  EXPECT_GT(crocks, 0.55 * 3000);
}

// Published, after physics: 10.1 and 10.0, including the table. Samples before physics have more.
TEST(BreakfastTable, HasNotManyMoreThingsThanPublished) {
  double sums[2] = {0.0, 0.0};
  for (const bool high : {false, true}) {
    for (const SceneSample& sample : GrammarBreakfastDraws(high)) {
      sums[high] += static_cast<double>(sample.objects.size()) / 3000.0;
      ASSERT_LE(sample.objects.size(), high ? 46u : 35u);
      ASSERT_GE(sample.objects.size(), 4u);
    }
  }
  RecordProperty("low", std::to_string(sums[0]));
  RecordProperty("high", std::to_string(sums[1]));
  EXPECT_NEAR(sums[0], 10.1, 2.5);
  EXPECT_NEAR(sums[1], 10.0, 7.0);
}

// Seen from the seat, forks are left of their plate and knives right, and mugs beyond.
TEST(BreakfastTable, CutleryLiesWhereItBelongs) {
  int forks = 0, knives = 0, mugs = 0;
  for (const SceneSample& sample : GrammarBreakfastDraws(true)) {
    const SceneObject* plate = nullptr;  // objects of a setting follow it
    for (const SceneObject& object : sample.objects) {
      if (object.symbol == "own_plate") plate = &object;
      if (plate == nullptr || !IsBase(sample, object)) continue;
      // A person at negative x looks along x; left is y.
      const double facing = PlaceOf(*plate).x() < 0.0 ? 1.0 : -1.0;
      const Eigen::Vector3d way = facing * (PlaceOf(object) - PlaceOf(*plate));
      const double along = object.world_from_object.linear()(0, 0) * facing;
      if (object.category == "fork" || object.category == "knife") {
        const bool is_fork = object.category == "fork";
        ++(is_fork ? forks : knives);
        ASSERT_NEAR(way.y(), is_fork ? 0.12 : -0.12, 1e-12);
        ASSERT_NEAR(way.x(), -0.05, 0.06);
        ASSERT_GT(along, 0.7);
      } else if (object.category == "mug") {
        ++mugs;
        ASSERT_NEAR(way.x(), 0.13, 0.08);
        ASSERT_NEAR(way.y(), -0.13, 0.08);
      }
    }
  }
  EXPECT_GT(std::min({forks, knives, mugs}), 3000);
}

TEST(BreakfastTable, UtensilsStandInTheirCrock) {
  int standing = 0;
  for (const SceneSample& sample : GrammarBreakfastDraws(false)) {
    for (const SceneObject& object : sample.objects) {
      if (object.parent <= 0) continue;
      const SceneObject& below = ParentOf(sample, object);
      if (below.category != "utensil_crock") continue;
      ++standing;
      ASSERT_NEAR(object.world_from_object.linear().col(0).z(), 1.0, 1e-9);
      const CategorySize& size = SizeOf(DefaultCategorySizes(), object.category);
      const double floor = PlaceOf(below).z() + 0.01;
      ASSERT_NEAR(PlaceOf(object).z() - size.half_size.x(), floor, 1e-9);
    }
  }
  EXPECT_GT(standing, 5000);
}

}  // namespace
}  // namespace simwright::scene
