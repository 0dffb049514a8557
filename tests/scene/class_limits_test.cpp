// The limits that prompts set to classes.
#include "scene/prompt/class_limits.h"

#include <gtest/gtest.h>

namespace simwright::scene {
namespace {

Vocabulary LimitWords() {
  return {
      "test", 20, {"apple", "can_1", "can_2", "cup", "shelf"}, {false, false, false, false, true}};
}

TEST(ClassLimits, OfACount) {
  Prompt prompt{PromptKind::kCount, 7, {}, false, {}, {}};
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()), (std::vector<ClassLimit>{{{0, 1, 2, 3}, 7, 7}}));
}

TEST(ClassLimits, OfNames) {
  Prompt prompt{PromptKind::kNames, {}, {{"apple", 2}, {"can", 3}}, false, {}, {}};
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()),
            (std::vector<ClassLimit>{{{0}, 2, 2}, {{1, 2}, 3, 3}, {{3}, 0, 0}}));
  prompt.and_others = true;
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()).back(), (ClassLimit{{3}, 1, 14}));
  prompt.count = 9;
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()).back(), (ClassLimit{{3}, 4, 4}));
  prompt.count = 3;  // fewer than the names
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()).back(), (ClassLimit{{3}, 0, 0}));
}

TEST(ClassLimits, LeaveAnEntryForFurniture) {
  Prompt prompt{PromptKind::kNames, {}, {{"apple", 15}, {"can", 200}}, false, {}, {}};
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()),
            (std::vector<ClassLimit>{{{0}, 15, 15}, {{1, 2}, 4, 4}, {{3}, 0, 0}}));
}

// A union vocabulary with the table of another type.
TEST(ClassLimits, OneMainFurnitureAndNoneOfOtherTypes) {
  Vocabulary vocabulary{
      "pantry_shelf", 20, {"apple", "shelf_pantry", "table_round"}, {false, true, true}};
  Prompt prompt{PromptKind::kNames, {}, {{"apple", 2}}, false, {}, {}};
  EXPECT_EQ(ClassLimitsOf(prompt, vocabulary),
            (std::vector<ClassLimit>{{{0}, 2, 2}, {{1}, 1, 1}, {{2}, 0, 0}}));
  EXPECT_TRUE(ClassLimitsOf({}, vocabulary).empty());
}

TEST(ClassLimits, OfNoneAndOfAllNames) {
  EXPECT_TRUE(ClassLimitsOf({}, LimitWords()).empty());
  Prompt prompt{PromptKind::kNames, {}, {{"apple", 0}, {"can", 1}, {"cup", 2}}, true, {}, {}};
  EXPECT_EQ(ClassLimitsOf(prompt, LimitWords()),
            (std::vector<ClassLimit>{{{0}, 0, 0}, {{1, 2}, 1, 1}, {{3}, 2, 2}}));
}

}  // namespace
}  // namespace simwright::scene
