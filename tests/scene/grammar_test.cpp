// The nodes, pose rules and constraints of scene grammars, against closed forms.
#include "scene/grammar/grammar.h"

#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/grammar/grammar_builder.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

constexpr int kDraws = 20000;

// Returns how often each number of objects (up to 31) was sampled.
std::vector<int> Counts(const Grammar& grammar) {
  core::Rng rng = core::StreamRng(5, 0);
  std::vector<int> counts(32, 0);
  for (int i = 0; i < kDraws; ++i) {
    ++counts[std::min<size_t>(31, SampleGrammar(grammar, rng).objects.size())];
  }
  return counts;
}

// Returns chi-square over the cells with an expected count of at least five; the degrees of freedom
// are one less than their number.
double ChiSquare(const std::vector<int>& counts, const std::vector<double>& probabilities,
                 int* cells) {
  double sum = 0.0;
  *cells = 0;
  for (size_t k = 0; k < probabilities.size(); ++k) {
    const double expected = kDraws * probabilities[k];
    if (expected < 5.0) continue;
    sum += (counts[k] - expected) * (counts[k] - expected) / expected;
    ++*cells;
  }
  return sum;
}

GrammarBuilder Apples(const std::vector<double>& counts) {
  GrammarBuilder builder("apples", "room");
  builder.Repeat("room", counts,
                 Always("apple", UniformInWorld({-1, -1, 0}, {1, 1, 0}).WithFreeYaw()));
  builder.Leaf(Object("apple", "apple"));
  return builder;
}

// P(k) ~ (1 - p)^k p for k = 0 .. n.
TEST(Grammar, CountsAreGeometric) {
  const double p = 0.4;
  const int last = 6;
  std::vector<double> truth;
  for (int k = 0; k <= last; ++k) {
    truth.push_back(std::pow(1.0 - p, k) * p / (1.0 - std::pow(1.0 - p, last + 1)));
  }
  int cells = 0;
  const std::vector<int> counts = Counts(Apples(GeometricWeights(p, 0, last)).Build());
  // 99.9 % of 6 degrees of freedom: 22.5.
  EXPECT_LT(ChiSquare(counts, truth, &cells), 22.5);
  EXPECT_EQ(cells, 7);
  for (size_t k = 7; k < counts.size(); ++k) EXPECT_EQ(counts[k], 0);
}

TEST(Grammar, ChoicesAreByTheirWeight) {
  GrammarBuilder builder("choice", "room");
  builder.Or("room",
             {With(3.0, "apple"), With(1.0, "two"), With(0.0, "never"), With(1.0, kNothing)});
  builder.And("two", {Always("apple"), Always("apple")});
  builder.Leaf(Object("never", "pear"));
  builder.Leaf(Object("apple", "apple"));
  int cells = 0;
  // 99.9 % of 2 degrees of freedom: 13.8.
  EXPECT_LT(ChiSquare(Counts(builder.Build()), {0.2, 0.6, 0.2}, &cells), 13.8);
}

TEST(Grammar, MembersOfAnIndependentSetAreIndependent) {
  GrammarBuilder builder("set", "room");
  builder.Independent("room", {With(0.9, "apple"), With(0.5, "pear"), With(0.0, "never")});
  builder.Leaf(Object("apple", "apple"));
  builder.Leaf(Object("pear", "pear"));
  builder.Leaf(Object("never", "bowl"));
  core::Rng rng = core::StreamRng(6, 0);
  const Grammar grammar = builder.Build();
  std::map<std::string, int> seen;
  for (int i = 0; i < kDraws; ++i) {
    std::string all;
    for (const SceneObject& object : SampleGrammar(grammar, rng).objects)
      all += object.category + " ";
    ++seen[all];
  }
  // Four standard deviations of a share of 0.45.
  const double spread = 4.0 * std::sqrt(0.45 * 0.55 * kDraws);
  EXPECT_NEAR(seen["apple pear "], 0.45 * kDraws, spread);
  EXPECT_NEAR(seen["apple "], 0.45 * kDraws, spread);
  EXPECT_NEAR(seen["pear "], 0.05 * kDraws, spread);
  EXPECT_NEAR(seen[""], 0.05 * kDraws, spread);
}

TEST(Grammar, AGaussianOffsetIsInTheParentsFrame) {
  GrammarBuilder builder("offset", "room");
  builder.And("room", {Always("plate", Offset(1.0, 0.0).WithYaw(0.5 * M_PI))});
  builder.And(Object("plate", "plate"),
              {Always("cup", GaussianOffset({0.3, 0.0, 0.0}, {0.05, 0.01, 0.0}))});
  builder.Leaf(Object("cup", "cup"));
  const Grammar grammar = builder.Build();
  core::Rng rng = core::StreamRng(7, 0);
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Vector3d at = SampleGrammar(grammar, rng).objects[1].world_from_object.translation();
    sum += at;
    squares += at.cwiseAbs2();
  }
  const Vector3d mean = sum / kDraws;
  const Vector3d deviation = (squares / kDraws - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  // The plate's x is the world's y.
  EXPECT_LT((mean - Vector3d(1.0, 0.3, 0.0)).norm(), 0.002);
  EXPECT_NEAR(deviation.y(), 0.05, 0.001);
  EXPECT_NEAR(deviation.x(), 0.01, 0.0003);
}

// Poses are resampled until they are apart, so that they are uniform over the allowed set: the
// corners of a bar that holds two discs of 0.3 m, |x1 - x2| >= 0.6 in [0, 1], where each is
// triangular.
TEST(Grammar, KeepOutsAreKept) {
  GrammarBuilder builder("bar", "room");
  const PoseRule rule = UniformOnSurface({0, 0, 0}, {1, 0, 0});
  builder.And(Surface("room"), {Always("a", rule), Always("b", rule)});
  builder.Leaf(Object("a", "apple"));
  builder.Leaf(Object("b", "pear"));
  KeepOut apart;
  apart.name = "apart";
  apart.bodies = {{"a", 0.3}, {"b", 0.3}};
  builder.Require(apart);
  const Grammar grammar = builder.Build();
  core::Rng rng = core::StreamRng(8, 0);
  double way = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const SceneSample sample = SampleGrammar(grammar, rng);
    const double x = std::abs(sample.objects[0].world_from_object.translation().x() -
                              sample.objects[1].world_from_object.translation().x());
    ASSERT_GE(x, 0.6 - 1e-12);
    way += x;
  }
  // The mean of d with density ~ (1 - d) on [0.6, 1]: 0.6 + 0.4 / 3.
  EXPECT_NEAR(way / kDraws, 0.6 + 0.4 / 3.0, 0.01);
}

// One disc of 0.3 m in [0, 1], or two: two are 0.6 m apart with probability 0.4^2. With rejection a
// failed derivation counts, so that a single disc is sampled more often.
TEST(Grammar, ARejectedPoseCountsItsDerivation) {
  GrammarBuilder builder("bar", "room");
  builder.Repeat(Surface("room"), {0.0, 1.0, 1.0},
                 Always("a", UniformOnSurface({0, 0, 0}, {1, 0, 0})));
  builder.Leaf(Object("a", "apple"));
  KeepOut apart;
  apart.name = "apart";
  apart.bodies = {{"a", 0.3}};
  apart.decision = Decision::kReject;
  builder.Require(apart);
  const Grammar grammar = builder.Build();
  core::Rng rng = core::StreamRng(8, 1);
  int both = 0, derivations = 0;
  for (int i = 0; i < kDraws; ++i) {
    const SceneSample sample = SampleGrammar(grammar, rng);
    derivations += sample.derivations;
    if (sample.objects.size() < 2) continue;
    ++both;
    ASSERT_GE(std::abs(sample.objects[0].world_from_object.translation().x() -
                       sample.objects[1].world_from_object.translation().x()),
              0.6);
  }
  const double accepted = 0.5 + 0.5 * 0.16;
  const double share = 0.5 * 0.16 / accepted;
  // Four standard deviations each.
  EXPECT_NEAR(both / static_cast<double>(kDraws), share,
              4.0 * std::sqrt(share * (1.0 - share) / kDraws));
  EXPECT_NEAR(derivations / static_cast<double>(kDraws), 1.0 / accepted,
              4.0 * std::sqrt((1.0 - accepted) / kDraws) / accepted);
}

TEST(Grammar, StructureIsDecidedByRejection) {
  GrammarBuilder builder = Apples(GeometricWeights(0.5, 0, 8));
  builder.Require(ObjectsAtLeast(3));
  core::Rng rng = core::StreamRng(9, 0);
  const Grammar grammar = builder.Build();
  std::vector<int> counts(32, 0);
  int derivations = 0;
  for (int i = 0; i < kDraws; ++i) {
    const SceneSample sample = SampleGrammar(grammar, rng);
    ++counts[sample.objects.size()];
    derivations += sample.derivations;
  }
  std::vector<double> truth(9, 0.0);
  double total = 0.0;
  for (int k = 3; k <= 8; ++k) total += truth[static_cast<size_t>(k)] = std::pow(0.5, k);
  for (double& value : truth) value /= total;
  int cells = 0;
  EXPECT_LT(ChiSquare(counts, truth, &cells), 20.5);  // 99.9 % of 5 degrees
  // P(k >= 3) = (1/8 - 1/512) / (1 - 1/512).
  const double accepted = (1.0 / 8 - 1.0 / 512) / (1.0 - 1.0 / 512);
  EXPECT_NEAR(derivations / static_cast<double>(kDraws), 1.0 / accepted, 0.2);
}

std::string GrammarErrorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Grammar, WhatCanNeverBeSaysWhichConstraintAndHowOften) {
  GrammarBuilder builder = Apples(GeometricWeights(0.5, 0, 3));
  builder.Require(ObjectsAtLeast(5));
  GrammarSampleOptions options;
  options.tries = 2;
  builder.Options(options);
  core::Rng rng = core::StreamRng(1, 0);
  const std::string error = GrammarErrorOf([&] { SampleGrammar(builder.Build(), rng); });
  EXPECT_NE(error.find("at least 5 objects"), std::string::npos) << error;
  EXPECT_NE(error.find("2000 derivations"), std::string::npos) << error;

  GrammarBuilder crowd("crowd", "room");
  const PoseRule rule = UniformOnSurface({0, 0, 0}, {0.1, 0.1, 0});
  crowd.And(Surface("room"), {Always("a", rule), Always("b", rule)});
  crowd.Leaf(Object("a", "apple"));
  crowd.Leaf(Object("b", "pear"));
  KeepOut apart;
  apart.name = "of the crowd";
  apart.bodies = {{"a", 0.3}, {"b", 0.3}};
  crowd.Require(apart);
  crowd.Options(options);
  const std::string second = GrammarErrorOf([&] { SampleGrammar(crowd.Build(), rng); });
  EXPECT_NE(second.find("keep-out of the crowd"), std::string::npos) << second;
}

TEST(Grammar, WhatIsNotSoundIsRefusedByName) {
  GrammarBuilder twice = Apples({1.0});
  twice.Leaf(Object("apple", "pear"));
  EXPECT_NE(GrammarErrorOf([&] { twice.Build(); }).find("apple"), std::string::npos);
  GrammarBuilder missing("missing", "room");
  missing.And("room", {Always("ghost")});
  EXPECT_NE(GrammarErrorOf([&] { missing.Build(); }).find("ghost"), std::string::npos);
  GrammarBuilder empty("empty", "room");
  empty.Leaf("room");
  EXPECT_NE(GrammarErrorOf([&] { empty.Build(); }).find("no object"), std::string::npos);
  EXPECT_THROW(GeometricWeights(0.0, 0, 3), core::Error);
  GrammarSampleOptions options;
  options.tries = 0;
  EXPECT_THROW(Apples({0.0, 1.0}).Build().WithOptions(options), core::Error);
  // A symbol that always derives itself.
  GrammarBuilder endless("endless", "tower");
  endless.And(Object("tower", "steamer"), {Always("tower")});
  core::Rng rng = core::StreamRng(1, 0);
  EXPECT_NE(GrammarErrorOf([&] { SampleGrammar(endless.Build(), rng); }).find("10000 nodes"),
            std::string::npos);
}

}  // namespace
}  // namespace simwright::scene
