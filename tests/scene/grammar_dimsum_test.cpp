// Dimsum tables: the published probabilities and the invariants of every scene.
#include "scene/scene_types/dimsum.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "scene/grammar/scene_sample.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

constexpr double kTabletop = 0.785;

std::vector<SceneSample> GrammarDimsumDraws(int count) {
  const Grammar grammar = DimsumTable();
  std::vector<SceneSample> samples;
  for (int i = 0; i < count; ++i) {
    core::Rng rng = core::StreamRng(1, static_cast<std::uint64_t>(i));
    samples.push_back(SampleGrammar(grammar, rng));
  }
  return samples;
}

constexpr int kScenes = 300;

const std::vector<SceneSample>& Some() {
  static const std::vector<SceneSample> samples = GrammarDimsumDraws(kScenes);
  return samples;
}

int CountGrammarDimsumOf(const SceneSample& sample, const std::string& category) {
  return static_cast<int>(
      std::count_if(sample.objects.begin(), sample.objects.end(),
                    [&](const SceneObject& o) { return o.category == category; }));
}

// The height of each stack of steamers.
std::vector<int> Stacks(const SceneSample& sample) {
  std::map<int, int> level;
  std::vector<int> heights;
  for (size_t i = 0; i < sample.objects.size(); ++i) {
    if (sample.objects[i].category != "steamer") continue;
    const auto below = level.find(sample.objects[i].parent);
    level[static_cast<int>(i)] = below == level.end() ? 1 : below->second + 1;
    if (below == level.end()) heights.push_back(1);
    heights.back() = std::max(heights.back(), level[static_cast<int>(i)]);
  }
  return heights;
}

double GrammarDimsumKeepOutOf(const std::string& category) {
  const std::map<std::string, double> radii = {
      {"plate", 0.14}, {"cup", 0.07}, {"teapot", 0.10}, {"serving_dish", 0.20}, {"steamer", 0.12}};
  const auto found = radii.find(category);
  return found == radii.end() ? 0.0 : found->second;
}

TEST(DimsumTable, EverySceneKeepsItsConstraints) {
  for (const SceneSample& sample : Some()) {
    const std::vector<int> stacks = Stacks(sample);
    ASSERT_GE(stacks.size(), 3u);
    ASSERT_GE(*std::max_element(stacks.begin(), stacks.end()), 4);
    ASSERT_LE(sample.objects.size(), 34u);
    ASSERT_EQ(sample.objects[0].category, "table_round");
    ASSERT_TRUE(sample.objects[0].welded);
    for (size_t i = 1; i < sample.objects.size(); ++i) {
      const SceneObject& one = sample.objects[i];
      const Vector3d at = one.world_from_object.translation();
      if (one.parent != 0) continue;  // stands on another
      ASSERT_NEAR(at.z(), kTabletop, 1e-12);
      const double margin = one.category == "plate" ? 0.1 : 0.15;
      ASSERT_LE(at.head<2>().norm(), 0.625 - margin + 1e-9);
      for (size_t j = i + 1; j < sample.objects.size(); ++j) {
        const SceneObject& other = sample.objects[j];
        if (other.parent != 0) continue;
        const Vector3d way = other.world_from_object.translation() - at;
        ASSERT_GE(way.head<2>().norm(), GrammarDimsumKeepOutOf(one.category) +
                                            GrammarDimsumKeepOutOf(other.category) - 1e-9);
      }
    }
  }
}

TEST(DimsumTable, SteamersStandOnEachOther) {
  for (const SceneSample& sample : Some()) {
    for (const SceneObject& one : sample.objects) {
      if (one.parent <= 0) continue;
      const SceneObject& below = sample.objects[static_cast<size_t>(one.parent)];
      ASSERT_EQ(below.category, "steamer");
      const Vector3d way = below.world_from_object.inverse() * one.world_from_object.translation();
      ASSERT_LT((way - Vector3d(0, 0, 0.091)).norm(), 1e-12);
    }
  }
}

// A cup stands 0.25 m from its plate towards the middle, except where other objects interfere.
TEST(DimsumTable, CupsStandInwardsOfTheirPlates) {
  double inwards = 0.0;
  int pairs = 0;
  for (const SceneSample& sample : Some()) {
    for (size_t i = 0; i + 1 < sample.objects.size(); ++i) {
      if (sample.objects[i].category != "plate" || sample.objects[i + 1].category != "cup")
        continue;
      ++pairs;
      const Vector3d plate = sample.objects[i].world_from_object.translation();
      const Vector3d cup = sample.objects[i + 1].world_from_object.translation();
      inwards += plate.head<2>().norm() - cup.head<2>().norm();
      ASSERT_LT((cup - plate).norm(), 0.25 + 0.35);
    }
  }
  EXPECT_GT(pairs, 500);
  EXPECT_NEAR(inwards / pairs, 0.25, 0.04);
}

// Weights of 0.7 + 0.025 + 0.025 + 0.2. Many stacks and dishes leave less space for settings, so
// that those with plate and cup are rejected more often than empty ones.
TEST(DimsumTable, SettingsAreAsOftenAsPublished) {
  int plates = 0, cups = 0;
  for (const SceneSample& sample : Some()) {
    plates += CountGrammarDimsumOf(sample, "plate");
    cups += CountGrammarDimsumOf(sample, "cup");
  }
  const double settings = 4.0 * kScenes;
  EXPECT_NEAR(plates / settings, 0.725 / 0.95, 0.06);
  EXPECT_NEAR(cups / settings, 0.725 / 0.95, 0.06);
}

TEST(DimsumTable, HasAsManyObjectsAsPublished) {
  double sum = 0.0;
  size_t most = 0;
  for (const SceneSample& sample : Some()) {
    sum += static_cast<double>(sample.objects.size());
    most = std::max(most, sample.objects.size());
  }
  RecordProperty("mean", std::to_string(sum / kScenes));
  EXPECT_NEAR(sum / kScenes, 17.1, 2.0);
  EXPECT_LE(most, 34u);
  EXPECT_GE(most, 22u);
}

TEST(DimsumTable, TheSameStateGivesTheSameScene) {
  const std::vector<SceneSample> again = GrammarDimsumDraws(5);
  for (size_t k = 0; k < again.size(); ++k) {
    const SceneSample& sample = Some()[k];
    ASSERT_EQ(again[k].objects.size(), sample.objects.size());
    for (size_t i = 0; i < sample.objects.size(); ++i) {
      EXPECT_EQ(again[k].objects[i].world_from_object.matrix(),
                sample.objects[i].world_from_object.matrix());
    }
  }
}

}  // namespace
}  // namespace simwright::scene
