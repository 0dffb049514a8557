// Agreement of scenes with prompts: closed forms and hand-made scenes.
#include "scene/prompt/prompt_agreement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/scene/prompt_scenes.h"

namespace simwright::scene {
namespace {

TEST(PromptAgreement, CountsHaveTheirClosedForm) {
  EXPECT_EQ(CountAgreement(12, 12), 1.0);
  // 1 - ln 3 / ln 9 = 1 - 1/2.
  EXPECT_NEAR(CountAgreement(8, 10), 0.5, 1e-12);
  EXPECT_NEAR(CountAgreement(8, 6), 0.5, 1e-12);
  EXPECT_NEAR(CountAgreement(8, 0), 0.0, 1e-12);
  EXPECT_EQ(CountAgreement(8, 100), 0.0);
  // n = 1: ln(1 + D) / ln 2 is 1 for D = 1.
  EXPECT_EQ(CountAgreement(1, 1), 1.0);
  EXPECT_NEAR(CountAgreement(1, 0), 0.0, 1e-12);
  EXPECT_EQ(CountAgreement(0, 0), 1.0);
  EXPECT_EQ(CountAgreement(0, 3), 0.0);
}

TEST(PromptAgreement, NamesHaveTheirClosedForm) {
  const std::vector<NamedCount> names = {{"apple", 4}, {"bowl", 1}};
  EXPECT_EQ(NamesAgreement(names, {4, 1}, false), 1.0);
  // Apples: 4 (1 - 1/4) = 3; bowls: 1 (1 - 1/1) = 0; of 5.
  EXPECT_NEAR(NamesAgreement(names, {3, 0}, false), 0.6, 1e-12);
  EXPECT_NEAR(NamesAgreement(names, {5, 2}, false), 0.6, 1e-12);
  EXPECT_EQ(NamesAgreement(names, {5, 2}, true), 1.0);
  EXPECT_EQ(NamesAgreement(names, {20, 1}, false), 0.2);
  EXPECT_EQ(NamesAgreement({}, {}, false), 1.0);
  // "two apples and no bowls": weights 2 and 1.
  const std::vector<NamedCount> without = {{"apple", 2}, {"bowl", 0}};
  EXPECT_EQ(NamesAgreement(without, {2, 0}, false), 1.0);
  EXPECT_NEAR(NamesAgreement(without, {2, 1}, true), 2.0 / 3.0, 1e-12);
}

std::vector<SceneObject> AgreementScene() {
  // From left to right: an apple, a bowl with an apple in it; a cup on the far right.
  return {PromptObject("apple", 0, 0.15, 0.75), PromptObject("bowl", 0, 0, 0.75),
          PromptObject("apple_3", 0, 0, 0.77), PromptObject("cup", 0, -1, 0.75)};
}

TEST(PromptAgreement, StatementsHoldForTheOrdinalsOfTheScene) {
  Prompt prompt{PromptKind::kRelations, {}, {{"apple", 2}, {"bowl", 1}, {"cup", 1}}, false, {}, {}};
  prompt.relations = {{{"apple", 1}, Relation::kLeftOf, {"bowl", 0}},
                      {{"apple", 2}, Relation::kInside, {"bowl", 0}}};
  PromptAgreement agreement = AgreementWith(prompt, AgreementScene(), DefaultCategorySizes());
  EXPECT_TRUE(agreement.strict);
  EXPECT_EQ(agreement.StatementShare(), 1.0);
  // With the ordinals exchanged neither holds, but each holds for some apple.
  std::swap(prompt.relations[0].subject, prompt.relations[1].subject);
  agreement = AgreementWith(prompt, AgreementScene(), DefaultCategorySizes());
  EXPECT_EQ(agreement.statements, 2);
  EXPECT_EQ(agreement.held, 0);
  EXPECT_EQ(agreement.held_by_any, 2);
  EXPECT_FALSE(agreement.strict);
  EXPECT_EQ(agreement.apf, 1.0);
  prompt.relations = {{{"apple", 0}, Relation::kInside, {"bowl", 0}},
                      {{"cup", 0}, Relation::kNextTo, {"bowl", 0}}};
  agreement = AgreementWith(prompt, AgreementScene(), DefaultCategorySizes());
  EXPECT_EQ(agreement.StatementShare(), 0.5);
  EXPECT_EQ(agreement.holds, (std::vector<char>{1, 0}));
}

TEST(PromptAgreement, StrictMatchCountsEverything) {
  const auto strict = [](const Prompt& prompt) {
    return AgreementWith(prompt, AgreementScene(), DefaultCategorySizes()).strict;
  };
  const std::vector<NamedCount> some = {{"apple", 1}, {"bowl", 1}};
  EXPECT_FALSE(strict({PromptKind::kNames, {}, some, false, {}, {}}));
  EXPECT_TRUE(strict({PromptKind::kNames, {}, some, true, {}, {}}));
  EXPECT_FALSE(strict({PromptKind::kNames, {}, {{"apple", 2}, {"bowl", 1}}, false, {}, {}}));
  EXPECT_FALSE(strict({PromptKind::kNames, {}, {{"apple", 2}, {"bowl", 0}}, true, {}, {}}));
  EXPECT_TRUE(strict({PromptKind::kCount, 4, {}, false, {}, {}}));
  EXPECT_FALSE(strict({PromptKind::kCount, 5, {}, false, {}, {}}));
  EXPECT_TRUE(strict({}));
  // A lacking object makes its statement false.
  Prompt prompt{PromptKind::kRelations, {}, {{"apple", 2}, {"fork", 1}}, true, {}, {}};
  prompt.relations = {{{"fork", 0}, Relation::kOn, {"apple", 3}}};
  EXPECT_THROW(strict(prompt), core::Error);
  prompt.relations[0].object.ordinal = 2;
  EXPECT_FALSE(strict(prompt));
}

TEST(PromptAgreement, ChanceIsTheShareOfShuffledPositions) {
  Prompt prompt{PromptKind::kRelations, {}, {{"mug", 1}, {"bowl", 1}}, false, {}, {}};
  prompt.relations = {{{"mug", 0}, Relation::kLeftOf, {"bowl", 0}}};
  const std::vector<SceneObject> scene = {PromptObject("mug", 0, 0.15, 0.75),
                                          PromptObject("bowl", 0, 0, 0.75)};
  core::Rng rng(4);
  // Two objects are exchanged in half of the permutations.
  EXPECT_NEAR(ChanceStatementShare(prompt, scene, DefaultCategorySizes(), 2000, rng), 0.5, 0.05);
  EXPECT_THROW(ChanceStatementShare(prompt, scene, DefaultCategorySizes(), 0, rng), core::Error);
}

}  // namespace
}  // namespace simwright::scene
