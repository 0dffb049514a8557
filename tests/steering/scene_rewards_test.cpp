// Rewards of scenes, and expressions of counts.
#include "steering/rewards/scene_rewards.h"

#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/prompt/object_names.h"
#include "tests/steering/steering_scenes.h"

namespace simwright::steering {
namespace {

const std::vector<std::string> kNames = {"apple", "can", "tea bottle"};

double ValueOf(const std::string& text, double apples, double cans, double feasible_apples = 0.0) {
  const CountExpression expression = CountExpression::Parse(text, kNames);
  CountExpression::Counts counts;
  for (const std::string& name : expression.names()) {
    counts.there.push_back(name == "apple" ? apples : name == "can" ? cans : 0.0);
    counts.feasible.push_back(name == "apple" ? feasible_apples : 0.0);
  }
  counts.all = apples + cans;
  counts.all_feasible = feasible_apples;
  return expression.Evaluate(counts);
}

TEST(CountExpression, FollowsArithmetic) {
  EXPECT_DOUBLE_EQ(ValueOf("count(apple) + 2*count(can)", 3, 4), 11);
  EXPECT_DOUBLE_EQ(ValueOf("count(apples)-count(cans)-1", 3, 4), -2);
  EXPECT_DOUBLE_EQ(ValueOf("-(count(apple) - 10) / 2", 3, 4), 3.5);
  EXPECT_DOUBLE_EQ(ValueOf("2 - -3 * 4", 0, 0), 14);
  EXPECT_DOUBLE_EQ(ValueOf("12 / 2 / 3", 0, 0), 2);
  EXPECT_DOUBLE_EQ(ValueOf("min(count(), 5) + max(count(can), 1.5)", 3, 1), 5.5);
  EXPECT_DOUBLE_EQ(ValueOf("feasible(apple) * 10 + feasible()", 3, 4, 2), 22);
  EXPECT_DOUBLE_EQ(ValueOf("count( tea_bottle )+count(Tea Bottles)", 3, 4), 0);
  EXPECT_DOUBLE_EQ(ValueOf("1 / count(can)", 3, 0), 0);
}

TEST(CountExpression, NamesTheFaultAndItsPlace) {
  const auto message = [](const std::string& text) {
    try {
      CountExpression::Parse(text, kNames);
    } catch (const core::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("count(apple) + ").find("character 16"), std::string::npos);
  EXPECT_NE(message("count(banana)").find("apple, can, tea bottle"), std::string::npos);
  EXPECT_NE(message("sum(apple)").find("\"sum\" is no function"), std::string::npos);
  for (const std::string text :
       {"", "(", "()", "count(", "count(apple", "count", "1..2", "1 2", "count(apple) count(can)",
        "min(1)", "1 +* 2", "a", "count(apple))", "\x01", "system(1)"}) {
    EXPECT_FALSE(message(text).empty()) << text;
  }
  EXPECT_NE(message(std::string(200, '(') + "1" + std::string(200, ')')).find("too deep"),
            std::string::npos);
  EXPECT_NE(message(std::string(200, '-') + "1").find("too deep"), std::string::npos);
  EXPECT_NE(message(std::string(1001, ' ') + "1").find("1000"), std::string::npos);
}

TEST(CountExpression, BoundsEveryValue) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> count(0, 9);
  for (const std::string text :
       {"count(apple) + 2*count(can)", "count(apple) * (3 - count(can))", "-count(apple)",
        "min(count(apple), 4) / (1 + count(can))", "max(count(apple) - count(can), 2) - 7",
        "count(apple) / (count(can) + 1)", "1 / (count(apple) - 4)"}) {
    const double bound = CountExpression::Parse(text, kNames).UpperBound(9);
    for (int i = 0; i < 200; ++i) EXPECT_LE(ValueOf(text, count(random), count(random)), bound);
  }
  EXPECT_DOUBLE_EQ(CountExpression::Parse("count(apple) + 2*count(can)", kNames).UpperBound(9), 27);
  EXPECT_DOUBLE_EQ(CountExpression::Parse("5 - count(apple)", kNames).UpperBound(9), 5);
}

TEST(CountExpression, SurvivesRandomText) {
  std::mt19937 random(3);
  const std::string letters = "count(feasible)apple can min,max+-*/ 0.19(()))_\n";
  std::uniform_int_distribution<size_t> letter(0, letters.size() - 1), length(0, 40);
  int parsed = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (size_t k = length(random); k > 0; --k) text += letters[letter(random)];
    try {
      const CountExpression expression = CountExpression::Parse(text, kNames);
      EXPECT_TRUE(std::isfinite(expression.UpperBound(9)));
      ++parsed;
    } catch (const core::Error&) {
    }
  }
  EXPECT_GT(parsed, 10);
}

TEST(SceneRewards, CountObjectsByNameAndFeasibility) {
  const JudgedScene scene =
      Judge({ObjectAt("table", 0, 0, 0), ObjectAt("cup", 0, 0, kTableTop),
             ObjectAt("cup", 0.3, 0, kTableTop + 0.1), ObjectAt("plate", -0.3, 0, kTableTop)},
            TableAssets());
  const scene::Vocabulary vocabulary = TableVocabulary();
  EXPECT_EQ(RewardNamed("objects", vocabulary)->Evaluate(scene), 4);
  EXPECT_EQ(RewardNamed("feasible", vocabulary)->Evaluate(scene), 3);
  EXPECT_EQ(RewardNamed("feasible", vocabulary)->Goal(), 8);
  EXPECT_EQ(NamedCountReward(vocabulary, "cups")->Evaluate(scene), 1);
  EXPECT_EQ(RewardNamed("count(cup) + 10 * feasible(plate)", vocabulary)->Evaluate(scene), 12);
  EXPECT_EQ(RewardNamed("count()", vocabulary)->Evaluate(scene), 3);
  EXPECT_EQ(RewardNamed("count(cup) / (1 + count(plate))", vocabulary)->Goal(), 8);
  EXPECT_THROW(RewardNamed("count(cup) / 0", vocabulary), core::Error);
  EXPECT_THROW(RewardNamed("1 / (count(cup) - count(plate))", vocabulary), core::Error);
  EXPECT_THROW(NamedCountReward(vocabulary, "table"), core::Error);  // furniture has no name
}

TEST(SceneRewards, AskForAJudgedSceneWhereTheyNeedOne) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  JudgedScene scene;
  scene.objects = {ObjectAt("cup", 0, 0, 0)};
  EXPECT_FALSE(RewardNamed("count(cup)", vocabulary)->NeedsPhysics());
  EXPECT_EQ(RewardNamed("count(cup)", vocabulary)->Evaluate(scene), 1);
  EXPECT_TRUE(RewardNamed("feasible(cup)", vocabulary)->NeedsPhysics());
  EXPECT_THROW(RewardNamed("feasible(cup)", vocabulary)->Evaluate(scene), core::Error);
  EXPECT_THROW(RewardNamed("feasible", vocabulary)->Evaluate(scene), core::Error);
}

TEST(SceneRewards, CompareFeasibleObjectsWithAPrompt) {
  const scene::AssetSet assets = TableAssets();
  scene::Prompt prompt;
  prompt.kind = scene::PromptKind::kNames;
  prompt.names = {{"cup", 2}, {"plate", 1}};
  const auto reward = PromptReward(prompt, assets.Sizes());
  // One of two cups stands: (2 (1 - 1 / 2) + 1) / 3.
  const JudgedScene scene =
      Judge({ObjectAt("table", 0, 0, 0), ObjectAt("cup", 0, 0, kTableTop),
             ObjectAt("cup", 0.3, 0, kTableTop + 0.1), ObjectAt("plate", -0.3, 0, kTableTop)},
            assets);
  EXPECT_NEAR(reward->Evaluate(scene), 2.0 / 3.0, 1e-12);
  prompt.kind = scene::PromptKind::kRelations;
  prompt.relations = {{{"plate", 0}, scene::Relation::kLeftOf, {"cup", 0}}};
  EXPECT_NEAR(PromptReward(prompt, assets.Sizes())->Evaluate(scene), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(reward->Goal(), 1.0);
}

}  // namespace
}  // namespace simwright::steering
