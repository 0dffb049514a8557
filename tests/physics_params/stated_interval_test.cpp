#include "physics_params/stated_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "physics_params/log_normal_mixture.h"
#include "tests/physics_params/measured/measured_objects.h"

namespace simwright::physics_params {
namespace {

const KnowledgeBase& StatedBase() {
  return KnowledgeBase::Shipped();
}

const Category& RowNamed(const char* name) {
  return *StatedBase().FindCategory(name);
}

// A row without variants states its own range as the central 90 %.
TEST(StatedInterval, ARowAloneStatesItsRange) {
  const Category& knife = RowNamed("chef knife");
  ASSERT_TRUE(knife.variants.empty());
  const Interval mass = MixtureInterval(knife, StatedBase(), Quantity::kMass, 0.9);
  EXPECT_NEAR(mass.min, knife.mass.min, 1e-9);
  EXPECT_NEAR(mass.max, knife.mass.max, 1e-9);
  const Interval wider = MixtureInterval(knife, StatedBase(), Quantity::kMass, 0.95);
  EXPECT_NEAR(std::log(wider.max / wider.min) / std::log(mass.max / mass.min),
              1.959963984540054 / 1.6448536269514722, 1e-9);
  EXPECT_THROW(MixtureInterval(knife, StatedBase(), Quantity::kMass, 1.0), core::Error);
}

// Brute force: the shares of a million draws of the mixture below and above the interval.
TEST(StatedInterval, MixtureLeavesATwentiethOnEachSide) {
  const std::vector<LogNormal> mixture = {{0.7, 0.0, 0.3}, {0.2, -1.5, 0.4}, {0.1, 1.0, 0.1}};
  const Interval interval = CentralInterval(mixture, 0.9);
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  std::discrete_distribution<size_t> pick({0.7, 0.2, 0.1});
  constexpr int kDraws = 1000000;
  int below = 0, above = 0;
  for (int i = 0; i < kDraws; ++i) {
    const LogNormal& one = mixture[pick(engine)];
    const double value = std::exp(one.mean + one.deviation * normal(engine));
    below += value < interval.min ? 1 : 0;
    above += value > interval.max ? 1 : 0;
  }
  EXPECT_NEAR(below / static_cast<double>(kDraws), 0.05, 0.001);
  EXPECT_NEAR(above / static_cast<double>(kDraws), 0.05, 0.001);
}

TEST(StatedInterval, InflationIsTheMissAtItsEnds) {
  for (const Interval& range : {Interval{1.0, 1.02}, Interval{0.1, 4.0}}) {
    const Interval wide = Inflated(range, 0.4);
    EXPECT_NEAR(RelativeMiss(range, wide.min), 0.4, 1e-9);
    EXPECT_NEAR(RelativeMiss(range, wide.max), 0.4, 1e-9);
    EXPECT_LT(RelativeMiss(range, std::sqrt(range.min * range.max)), 0.0);
    const Interval point = Inflated(range, -9.0);
    EXPECT_EQ(point.min, point.max);
  }
}

// The shipped inflations are those that the tuning half gives, and nothing else.
TEST(StatedInterval, CalibrationIsTheTuningHalfs) {
  if (WordNet::Installed() == nullptr) GTEST_SKIP() << "wordnet-base is not installed";
  const std::vector<MeasuredObject> measured = MeasuredObjects();
  const std::vector<ResolvedObject> objects = ResolvedObjects(measured, false);
  for (const Quantity quantity : {Quantity::kMass, Quantity::kLongestSide}) {
    for (const double probability : {0.9, 0.95}) {
      EXPECT_NEAR(IntervalCalibration::Shipped().Inflation(quantity, probability),
                  ConformalQuantile(MissesOf(objects, quantity, probability), probability), 1e-4);
    }
  }
  EXPECT_THROW(IntervalCalibration::Shipped().Inflation(Quantity::kMass, 0.8), core::Error);
  EXPECT_THROW(IntervalCalibration("mass 0.9\n"), core::Error);
  EXPECT_THROW(IntervalCalibration("mass x 0.9\n"), core::Error);
}

// The held-out half: at least 0.88 covered where 0.9 is stated, and a bound on the interval score,
// which wider intervals cannot meet. Half of the former score of the masses, 5.50, is the aim.
TEST(StatedInterval, HoldsOnHeldOutObjects) {
  if (WordNet::Installed() == nullptr) GTEST_SKIP() << "wordnet-base is not installed";
  const std::vector<MeasuredObject> measured = MeasuredObjects();
  const std::vector<ResolvedObject> objects = ResolvedObjects(measured, false);
  const IntervalScores mass = ScoreIntervals(
      IntervalsOf(objects, Quantity::kMass, false, Statement::kCalibrated), kStatedProbability);
  EXPECT_GE(mass.count, 75);
  EXPECT_GE(mass.coverage, 0.88);
  EXPECT_GE(mass.coverage_range.max, kStatedProbability);
  EXPECT_LE(mass.mean_score, 3.0);
  EXPECT_LE(mass.median_factor, 12.0);
  const IntervalScores side =
      ScoreIntervals(IntervalsOf(objects, Quantity::kLongestSide, false, Statement::kCalibrated),
                     kStatedProbability);
  EXPECT_GE(side.count, 50);
  EXPECT_GE(side.coverage, 0.88);
  EXPECT_LE(side.mean_score, 0.9);
}

TEST(StatedInterval, HalvesHoldAtLeastAHundredObjectsOfDifferentKinds) {
  const std::vector<MeasuredObject> objects = MeasuredObjects();
  EXPECT_GE(objects.size(), 100u);
  std::map<std::string, bool> half_of;
  int tuning = 0;
  for (const MeasuredObject& object : objects) {
    tuning += object.tuning ? 1 : 0;
    const auto [known, added] = half_of.emplace(object.kind, object.tuning);
    EXPECT_EQ(known->second, object.tuning) << object.kind;
  }
  EXPECT_GE(tuning, 60);
  EXPECT_GE(static_cast<int>(objects.size()) - tuning, 60);
}

// Friction has seven measured values of one source: too few to calibrate, six lie in the ranges.
TEST(StatedInterval, FrictionRangesHoldMeasuredValues) {
  int held = 0, all = 0;
  for (const std::vector<std::string>& row : MeasuredRows("friction.txt")) {
    const Material* material = StatedBase().FindMaterial(row.at(1));
    ASSERT_NE(material, nullptr) << row[1];
    held += material->friction.Contains(std::stod(row.at(2))) ? 1 : 0;
    ++all;
  }
  EXPECT_EQ(all, 7);
  EXPECT_GE(held, 6);
}

TEST(Variants, MaterialChoosesTheVariant) {
  const Category& mug = RowNamed("mug");
  EXPECT_EQ(ChosenVariant(mug, StatedBase(), {}).name, "mug");
  const Category plastic = ChosenVariant(mug, StatedBase(), {"plastic", std::nullopt});
  EXPECT_EQ(plastic.name, "plastic mug");
  const Interval stated = StatedInterval(plastic, StatedBase(), Quantity::kMass);
  const Interval bare = StatedInterval(mug, StatedBase(), Quantity::kMass);
  EXPECT_LT(std::log(stated.max / stated.min), std::log(bare.max / bare.min));
  EXPECT_LT(stated.max, bare.max);
  const Category ceramic = ChosenVariant(mug, StatedBase(), {"ceramic", std::nullopt});
  EXPECT_EQ(ceramic.name, "mug");
  EXPECT_EQ(ceramic.materials, std::vector<std::string>{"ceramic"});
  try {
    ChosenVariant(mug, StatedBase(), {"concrete", std::nullopt});
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("--material one of: ceramic"), std::string::npos)
        << error.what();
  }
}

TEST(Variants, SizeClassChoosesTheVariantOrAThirdOfTheRange) {
  EXPECT_EQ(
      ChosenVariant(RowNamed("battery"), StatedBase(), {std::nullopt, SizeClass::kLarge}).name,
      "d battery");
  const Category& knife = RowNamed("chef knife");
  const Category medium = ChosenVariant(knife, StatedBase(), {std::nullopt, SizeClass::kMedium});
  EXPECT_NEAR(std::log(medium.mass.max / medium.mass.min),
              std::log(knife.mass.max / knife.mass.min) / 3.0, 1e-12);
  EXPECT_NEAR(medium.mass.min * medium.mass.max, knife.mass.min * knife.mass.max, 1e-12);
  EXPECT_THROW(SizeClassOf("tiny"), core::Error);
}

TEST(Variants, WeightsMustLeaveAShareToTheRow) {
  const char* rows =
      "cube|1-2|1-2|1-2|1-2|wood|solid|box|s\nsteel cube|1-2|1-2|1-2|9-12|wood|solid|box|s\n";
  const char* materials = "wood|400-800|0.3-0.5|0.2-0.4|handbook\n";
  const auto read = [&](const char* variants) {
    return KnowledgeBase(rows, materials, "s|someone\n", variants);
  };
  EXPECT_EQ(read("cube|steel cube|0.2|large|family\n").FindCategory("cube")->variants.size(), 1u);
  for (const char* wrong : {"cube|steel cube|1|large|family\n", "cube|steel cube|0|-|family\n",
                            "cube|glass cube|0.2|-|family\n", "die|steel cube|0.2|-|family\n",
                            "cube|steel cube|0.2|huge|family\n", "cube|steel cube|0.2|-\n"}) {
    EXPECT_THROW(read(wrong), core::Error) << wrong;
  }
}

}  // namespace
}  // namespace simwright::physics_params
