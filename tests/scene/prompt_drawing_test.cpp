// Prompts drawn from scenes: their text, their truth and their statistics.
#include "scene/prompt/prompt_drawing.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/error.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_agreement.h"
#include "scene/prompt/prompt_reading.h"
#include "tests/scene/prompt_scenes.h"

namespace simwright::scene {
namespace {

TEST(PromptNames, AreSpokenNames) {
  EXPECT_EQ(NameOfCategory("apple"), "apple");
  EXPECT_EQ(NameOfCategory("apple_12"), "apple");
  EXPECT_EQ(NameOfCategory("tea_bottle"), "tea bottle");
  EXPECT_EQ(NameOfCategory("board_game_small"), "small board game");
  EXPECT_EQ(NameOfCategory("toast"), "slice of toast");
  EXPECT_EQ(PluralOf("knife"), "knives");
  EXPECT_EQ(PluralOf("teaspoon"), "teaspoons");
  EXPECT_EQ(PluralOf("serving dish"), "serving dishes");
  EXPECT_EQ(PluralOf("cereal box"), "cereal boxes");
  EXPECT_EQ(PluralOf("slice of toast"), "slices of toast");
  EXPECT_EQ(PluralOf("toy"), "toys");
  EXPECT_EQ(PluralOf("berry"), "berries");
  EXPECT_EQ(WithArticle("avocado"), "an avocado");
  EXPECT_EQ(WithArticle("utensil crock"), "a utensil crock");
  EXPECT_EQ(WithArticle("bowl"), "a bowl");
  EXPECT_EQ(CountedName(0, "cup"), "no cups");
  EXPECT_EQ(CountedName(1, "apple"), "an apple");
  EXPECT_EQ(CountedName(20, "fork"), "twenty forks");
  EXPECT_EQ(CountedName(21, "fork"), "21 forks");
  EXPECT_EQ(OrdinalWord(2), "second");
  EXPECT_EQ(OrdinalWord(21), "21st");
  EXPECT_EQ(OrdinalWord(112), "112th");
}

TEST(PromptText, IsTheFixedWording) {
  Prompt prompt;
  EXPECT_EQ(prompt.Text(), "");
  prompt.kind = PromptKind::kCount;
  prompt.count = 12;
  EXPECT_EQ(prompt.Text(), "A scene with 12 objects.");
  prompt.count = 1;
  EXPECT_EQ(prompt.Text(), "A scene with 1 object.");
  prompt = {PromptKind::kNames, {}, {{"apple", 2}, {"bowl", 1}, {"fork", 1}}, false, {}, {}};
  EXPECT_EQ(prompt.Text(), "A scene with two apples, a bowl, and a fork.");
  prompt.names = {{"avocado", 1}, {"apple", 5}};
  EXPECT_EQ(prompt.Text(), "A scene with an avocado and five apples.");
  prompt.and_others = true;
  EXPECT_EQ(prompt.Text(), "A scene with an avocado, five apples, and some other objects.");
  prompt.kind = PromptKind::kRelations;
  prompt.relations = {{{"apple", 1}, Relation::kLeftOf, {"avocado", 0}}};
  prompt.tiers = {{{"apple", 2}, ShelfTier::kTop}};
  std::string error;
  EXPECT_TRUE(prompt.IsValid(&error)) << error;
  EXPECT_EQ(prompt.Text(),
            "A scene with an avocado, five apples, and some other objects. The first apple is to "
            "the left of the avocado. The second apple is on the top shelf.");
}

TEST(PromptText, InvalidPromptsSayWhy) {
  const auto fault = [](const Prompt& prompt) {
    std::string error;
    EXPECT_FALSE(prompt.IsValid(&error));
    return error;
  };
  const Prompt names{PromptKind::kNames, {}, {{"apple", 2}}, false, {}, {}};
  Prompt prompt = names;
  prompt.count = 1;
  EXPECT_NE(fault(prompt).find("2 objects are named"), std::string::npos);
  prompt = names;
  prompt.names.push_back({"apple", 1});
  EXPECT_NE(fault(prompt).find("named twice"), std::string::npos);
  prompt = names;
  prompt.kind = PromptKind::kRelations;
  EXPECT_NE(fault(prompt).find("kind"), std::string::npos);
  prompt.relations = {{{"apple", 3}, Relation::kOn, {"apple", 1}}};
  EXPECT_NE(fault(prompt).find("no apple number 3"), std::string::npos);
  prompt.relations = {{{"apple", 1}, Relation::kOn, {"apple", 1}}};
  EXPECT_NE(fault(prompt).find("itself"), std::string::npos);
  prompt.relations = {{{"apple", 1}, Relation::kOn, {"bowl", 0}}};
  EXPECT_NE(fault(prompt).find("not named"), std::string::npos);
}

TEST(DrawPrompt, HoldsInItsSceneAndIsReadBack) {
  for (const SceneType& type : SceneTypes()) {
    const std::vector<std::string> names =
        NamesOfVocabulary(VocabularyOf(type.make(DefaultCategorySizes())));
    const auto scenes = PromptScenes(type.name, type.name.starts_with("restaurant") ? 2 : 8);
    for (size_t s = 0; s < scenes.size(); ++s) {
      for (std::uint64_t i = 0; i < 60; ++i) {
        core::Rng rng = core::StreamRng(s, i);
        const Prompt prompt = DrawPrompt(scenes[s], DefaultCategorySizes(), {}, rng);
        const std::string text = prompt.Text();
        std::string error;
        ASSERT_TRUE(prompt.IsValid(&error)) << error << ": " << text;
        const PromptAgreement agreement = AgreementWith(prompt, scenes[s], DefaultCategorySizes());
        ASSERT_TRUE(agreement.strict) << text;
        ASSERT_EQ(agreement.apf, 1.0) << text;
        const PromptReading reading = ReadPrompt(text, names, nullptr);
        ASSERT_TRUE(reading.prompt == prompt) << text << "\n" << reading.text;
        ASSERT_EQ(reading.text, text);
        ASSERT_TRUE(reading.findings.empty()) << text << "\n" << reading.findings[0].sentence;
      }
    }
  }
}

TEST(DrawPrompt, KindsSubsetsAndRelationsHaveTheirShares) {
  const auto scenes = PromptScenes("pantry_shelf", 10);
  std::map<PromptKind, int> kinds;
  std::map<size_t, int> statements;
  std::set<std::string> relations;
  int named = 0, subsets = 0;
  constexpr int kDraws = 6000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    core::Rng rng = core::StreamRng(3, i);
    const Prompt prompt = DrawPrompt(scenes[i % 10], DefaultCategorySizes(), {}, rng);
    ++kinds[prompt.kind];
    if (prompt.kind == PromptKind::kCount) continue;
    ++named;
    subsets += prompt.and_others;
    if (prompt.kind == PromptKind::kNames) continue;
    ++statements[prompt.relations.size() + prompt.tiers.size()];
    for (const RelationStatement& one : prompt.relations) {
      relations.insert(RelationText(one.relation));
    }
  }
  // Four standard deviations of a share of 1/3 in 6000 are 0.024.
  for (const PromptKind kind : {PromptKind::kCount, PromptKind::kNames, PromptKind::kRelations}) {
    EXPECT_NEAR(kinds[kind], kDraws / 3, 0.024 * kDraws);
  }
  EXPECT_NEAR(subsets, named / 2, 0.03 * named);
  EXPECT_EQ(statements.size(), 5u);
  EXPECT_EQ(statements.begin()->first, 1u);
  for (const auto& [count, times] : statements) EXPECT_NEAR(times, 400, 90) << count;
  EXPECT_FALSE(relations.contains("facing"));
  EXPECT_TRUE(relations.contains("next to"));
  EXPECT_TRUE(relations.contains("above"));
}

TEST(DrawPrompt, SceneWithoutRelationsOrObjectsFallsBack) {
  PromptDrawingOptions options;
  options.count_weight = options.names_weight = 0.0;
  core::Rng rng(1);
  const std::vector<SceneObject> apart = {PromptObject("apple", 0, 0, 0),
                                          PromptObject("apple_2", 2, 0, 0)};
  options.subset = 0.0;
  const Prompt prompt = DrawPrompt(apart, DefaultCategorySizes(), options, rng);
  EXPECT_EQ(prompt.Text(), "A scene with two apples.");
  EXPECT_EQ(DrawPrompt({}, DefaultCategorySizes(), options, rng).Text(), "A scene with 0 objects.");
  const std::vector<SceneObject> near = {PromptObject("apple", 0, 0, 0),
                                         PromptObject("bowl", 0, -0.15, 0)};
  options.most_relations = 1;
  std::set<std::string> sentences;
  for (int i = 0; i < 200; ++i) {
    const std::string text = DrawPrompt(near, DefaultCategorySizes(), options, rng).Text();
    sentences.insert(text.substr(text.find('.') + 2));
  }
  EXPECT_EQ(sentences,
            (std::set<std::string>{
                "The apple is to the left of the bowl.", "The bowl is to the right of the apple.",
                "The apple is next to the bowl.", "The bowl is next to the apple."}));
  options.relations_weight = 0.0;
  EXPECT_THROW(DrawPrompt(near, DefaultCategorySizes(), options, rng), core::Error);
  EXPECT_THROW(DrawPrompt({PromptObject("zebra", 0, 0, 0)}, DefaultCategorySizes(), {}, rng),
               core::Error);
}

TEST(PromptDrawing, DrawsTheSameFromTokens) {
  for (const std::string type : {"pantry_shelf", "breakfast_low"}) {
    const Vocabulary vocabulary = VocabularyOf(SceneTypeNamed(type).make(DefaultCategorySizes()));
    const PromptDrawing drawing(vocabulary, DefaultCategorySizes());
    std::vector<float> tokens(static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()));
    for (const auto& scene : PromptScenes(type, 5)) {
      EncodeScene(scene, vocabulary, tokens.data());
      for (std::uint64_t i = 0; i < 50; ++i) {
        core::Rng one = core::StreamRng(2, i), other = core::StreamRng(2, i);
        const Prompt prompt = drawing.Draw(tokens.data(), one);
        EXPECT_EQ(prompt, DrawPrompt(DecodeScene(tokens.data(), vocabulary), DefaultCategorySizes(),
                                     {}, other));
        EXPECT_EQ(one, other);
      }
    }
  }
}

}  // namespace
}  // namespace simwright::scene
