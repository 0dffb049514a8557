// Restaurants: keep-out distances, checked independently of the grammar, and counts.
#include "scene/scene_types/restaurant.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tests/sanitized.h"
#include "tests/scene/sampled_objects.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

constexpr int kHighs = 100, kLows = 300;

std::vector<SceneSample> GrammarRestaurantDraws(const Grammar& grammar, int count) {
  std::vector<SceneSample> samples;
  for (int i = 0; i < count; ++i) {
    core::Rng rng = core::StreamRng(9, static_cast<std::uint64_t>(i));
    samples.push_back(SampleGrammar(grammar, rng));
  }
  return samples;
}

const std::vector<SceneSample>& Highs() {
  static const std::vector<SceneSample> samples = GrammarRestaurantDraws(RestaurantHigh(), kHighs);
  return samples;
}
const std::vector<SceneSample>& Lows() {
  static const std::vector<SceneSample> samples = GrammarRestaurantDraws(RestaurantLow(), kLows);
  return samples;
}

int CountGrammarRestaurantOf(const SceneSample& sample, const std::string& category) {
  return static_cast<int>(
      std::count_if(sample.objects.begin(), sample.objects.end(),
                    [&](const SceneObject& o) { return o.category == category; }));
}

TEST(Restaurant, TablesChairsAndShelvesAreKeptApart) {
  SKIP_UNDER_SANITIZERS();
  const std::map<std::string, double> radii = {
      {"table_restaurant", 0.8}, {"chair", 0.35}, {"shelf_living_room", 0.3}};
  for (const auto* samples : {&Highs(), &Lows()}) {
    for (const SceneSample& sample : *samples) {
      // With the table of each: four chairs come before each table.
      std::vector<std::pair<size_t, int>> placed;
      int group = 0;
      for (size_t i = 0; i < sample.objects.size(); ++i) {
        const SceneObject& one = sample.objects[i];
        if (radii.count(one.category) == 0) continue;
        placed.emplace_back(i, group);
        group += one.category != "chair";
      }
      for (size_t a = 0; a < placed.size(); ++a) {
        for (size_t b = a + 1; b < placed.size(); ++b) {
          if (placed[a].second == placed[b].second) continue;
          const SceneObject &one = sample.objects[placed[a].first],
                            &other = sample.objects[placed[b].first];
          ASSERT_GE(Across(one, other), radii.at(one.category) + radii.at(other.category) - 1e-12);
        }
      }
    }
  }
}

TEST(Restaurant, FurnitureIsWeldedAndChairsAreNot) {
  const std::set<std::string> welded = {"floor", "table_restaurant", "shelf_living_room"};
  for (const auto* samples : {&Highs(), &Lows()}) {
    for (const SceneSample& sample : *samples) {
      ASSERT_EQ(CountGrammarRestaurantOf(sample, "floor"), 1);
      ASSERT_EQ(sample.objects[0].category, "floor");
      ASSERT_NEAR(PlaceOf(sample.objects[0]).z(), -0.05, 1e-12);  // its upper side is at 0
      for (const SceneObject& one : sample.objects) {
        ASSERT_EQ(one.welded, welded.count(one.category) == 1) << one.category;
        const Vector3d at = PlaceOf(one);
        if (one.category == "table_restaurant") {
          ASSERT_NEAR(at.z(), 0.0, 1e-12);
          ASSERT_TRUE(at.x() >= -2.5 && at.x() <= 3.0 && std::abs(at.y()) <= 3.0);
        } else if (one.category == "shelf_living_room") {
          ASSERT_NEAR(at.z(), 0.0, 1e-12);
          ASSERT_NEAR(at.x(), -4.75, 1e-12);
          // It opens to its own -x: to the room.
          ASSERT_NEAR(one.world_from_object.linear()(0, 0), -1.0, 1e-12);
          ASSERT_LE(std::abs(at.y()), 3.0);
        }
      }
    }
  }
}

TEST(Restaurant, FourChairsStandAboutEachTableAndFaceIt) {
  double distance = 0.0;
  int chairs = 0;
  for (const SceneSample& sample : Highs()) {
    ASSERT_EQ(CountGrammarRestaurantOf(sample, "chair"),
              4 * CountGrammarRestaurantOf(sample, "table_restaurant"));
    Vector3d sum = Vector3d::Zero();
    for (size_t i = 0; i < sample.objects.size(); ++i) {
      const SceneObject& one = sample.objects[i];
      if (one.category != "chair") continue;
      ASSERT_EQ(ParentOf(sample, one).category, "floor");
      ASSERT_NEAR(PlaceOf(one).z(), 0.0, 1e-12);
      size_t table = i;  // their table follows
      while (sample.objects[table].category == "chair") ++table;
      ASSERT_EQ(sample.objects[table].category, "table_restaurant");
      const Vector3d way = PlaceOf(sample.objects[table]) - PlaceOf(one);
      distance += way.norm();
      ++chairs;
      ASSERT_GT(one.world_from_object.linear().col(0).dot(way.normalized()), 0.4);
      sum += way.normalized();
      if (table != i + 1) continue;
      // One per side: their displacements from the table almost cancel.
      ASSERT_LT(sum.norm(), 1.0);
      sum.setZero();
    }
  }
  // The mean of the length of a Gaussian about (1.1, 0) with variances 0.005 and 0.03 is about
  // 1.1 + 0.03 / (2 * 1.1).
  EXPECT_NEAR(distance / chairs, 1.1 + 0.03 / 2.2, 4.0 * std::sqrt(0.005 / chairs) + 0.005);
}

TEST(Restaurant, WhatStandsOnATableIsKeptApartAndInside) {
  const std::map<std::string, double> radii = {
      {"plate", 0.14}, {"cup", 0.07}, {"teapot", 0.10}, {"serving_dish", 0.20}, {"steamer", 0.12}};
  int pairs = 0;
  for (const auto* samples : {&Highs(), &Lows()}) {
    for (const SceneSample& sample : *samples) {
      for (size_t i = 0; i < sample.objects.size(); ++i) {
        const SceneObject& one = sample.objects[i];
        if (!IsBase(sample, one)) continue;
        if (ParentOf(sample, one).category != "table_restaurant") continue;
        ASSERT_NEAR(PlaceOf(one).z(), 0.785, 1e-12);
        ASSERT_LE(Across(one, ParentOf(sample, one)), one.category == "plate" ? 0.525 : 0.475);
        for (size_t j = i + 1; j < sample.objects.size(); ++j) {
          const SceneObject& other = sample.objects[j];
          if (other.parent != one.parent) continue;
          ASSERT_GE(Across(one, other), radii.at(one.category) + radii.at(other.category) - 1e-9);
          ++pairs;
        }
      }
    }
  }
  EXPECT_GT(pairs, 10000);
}

TEST(Restaurant, ShelvesHoldAtLeastThreeThingsBetweenThem) {
  for (const auto* samples : {&Highs(), &Lows()}) {
    for (const SceneSample& sample : *samples) {
      int on_shelves = 0;
      for (const SceneObject& one : sample.objects) {
        if (!IsBase(sample, one) || ParentOf(sample, one).category != "shelf_living_room") continue;
        ++on_shelves;
        const Vector3d there = ParentOf(sample, one).world_from_object.inverse() * PlaceOf(one);
        ASSERT_LT(std::abs(there.x()), 0.15);
        ASSERT_LT(std::abs(there.y()), 0.3);
        const auto height = std::lround(1e4 * there.z());
        ASSERT_TRUE(height == 170 || height == 2870 || height == 5470 || height == 8170);
      }
      // Stacked objects count as well, so that one or two bases may suffice.
      ASSERT_GE(on_shelves, 1);
      int all = 0;
      for (SceneObject one : sample.objects) {
        while (!one.welded) one = ParentOf(sample, one);
        all += one.category == "shelf_living_room";
      }
      ASSERT_GE(all - CountGrammarRestaurantOf(sample, "shelf_living_room"), 3);
    }
  }
}

int TallestStack(const SceneSample& sample) {
  int tallest = 0;
  for (SceneObject one : sample.objects) {
    int height = 0;
    while (one.category == "steamer") {
      ++height;
      one = ParentOf(sample, one);
    }
    tallest = std::max(tallest, height);
  }
  return tallest;
}

// Published, after physics: 60.5 and at most 125 objects, 35.1 and at most 107.
TEST(Restaurant, HasAsManyThingsAsPublished) {
  double high = 0.0, low = 0.0;
  for (const SceneSample& sample : Highs()) {
    high += static_cast<double>(sample.objects.size()) / kHighs;
    ASSERT_LE(sample.objects.size(), 125u);
    ASSERT_GE(TallestStack(sample), 3);
    const int tables = CountGrammarRestaurantOf(sample, "table_restaurant");
    ASSERT_TRUE(tables >= 3 && tables <= 10);
    ASSERT_GE(CountGrammarRestaurantOf(sample, "shelf_living_room"), 1);
    ASSERT_LE(CountGrammarRestaurantOf(sample, "shelf_living_room"), 5);
  }
  for (const SceneSample& sample : Lows()) {
    low += static_cast<double>(sample.objects.size()) / kLows;
    ASSERT_LE(sample.objects.size(), 107u);
    ASSERT_GE(TallestStack(sample), 2);
  }
  RecordProperty("high", std::to_string(high));
  RecordProperty("low", std::to_string(low));
  EXPECT_NEAR(high, 60.5, 5.0);
  EXPECT_NEAR(low, 35.1, 2.5);
}

TEST(Restaurant, TheSameStateGivesTheSameScene) {
  const std::vector<SceneSample> again = GrammarRestaurantDraws(RestaurantHigh(), 2);
  for (size_t k = 0; k < again.size(); ++k) {
    ASSERT_EQ(again[k].objects.size(), Highs()[k].objects.size());
    for (size_t i = 0; i < again[k].objects.size(); ++i) {
      EXPECT_EQ(again[k].objects[i].world_from_object.matrix(),
                Highs()[k].objects[i].world_from_object.matrix());
    }
  }
}

}  // namespace
}  // namespace simwright::scene
