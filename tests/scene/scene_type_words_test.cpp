// Scene types in prompts.
#include "scene/prompt/scene_type_words.h"

#include <gtest/gtest.h>

#include "scene/scene_types/scene_types.h"

namespace simwright::scene {
namespace {

std::vector<std::string> AllTypeNames() {
  std::vector<std::string> names;
  for (const SceneType& type : SceneTypes()) names.push_back(type.name);
  return names;
}

TEST(SceneTypeWords, ModelsReadTheTypeAtTheStartOfAPrompt) {
  EXPECT_EQ(PromptOfSceneType("A scene with two apples.", "pantry_shelf"),
            "A pantry shelf with two apples.");
  EXPECT_EQ(PromptOfSceneType("", "dimsum"), "A dimsum table.");
  EXPECT_EQ(PromptOfSceneType("", "garden_bench"), "A garden bench.");
}

TEST(SceneTypeWords, EachTypeIsReadBack) {
  for (const std::string& type : AllTypeNames()) {
    std::string text = PromptOfSceneType("A scene with 12 objects.", type);
    EXPECT_EQ(TakeSceneType(AllTypeNames(), &text), type);
    EXPECT_EQ(text, "A scene with 12 objects.");
  }
}

TEST(SceneTypeWords, ReadsOtherWordingsAndWholeWordsOnly) {
  const auto read = [](std::string text) {
    const std::optional<std::string> type = TakeSceneType(AllTypeNames(), &text);
    return type.value_or("-") + "|" + text;
  };
  EXPECT_EQ(read("A Dim Sum Table with a cup"), "dimsum|A scene with a cup");
  EXPECT_EQ(read("five apples in a pantry"), "pantry_shelf|five apples in a scene");
  EXPECT_EQ(read("a breakfast table"), "breakfast_high|a scene");
  EXPECT_EQ(read("a breakfast table for two"), "breakfast_low|a scene");
  EXPECT_EQ(read("pantrywoman"), "-|pantrywoman");
  EXPECT_EQ(read("two cups"), "-|two cups");
  EXPECT_EQ(read(""), "-|");
}

}  // namespace
}  // namespace simwright::scene
