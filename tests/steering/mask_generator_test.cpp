// The masks of a search, on scenes made by hand, and the repair of synthesized objects.
#include "steering/search/mask_generator.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/contact_groups.h"
#include "steering/search/scene_repair.h"
#include "steering_scenes.h"

namespace simwright::steering {
namespace {

using Flags = std::vector<char>;

TokenScene TokensOfScene(const std::vector<scene::SceneObject>& objects) {
  TokenScene scene = TokenScene::Empty(TableVocabulary());
  EncodeScene(objects, TableVocabulary(), scene.tokens.data());
  return scene;
}

// A table, a cup that stands, two that penetrate, one that floats; three entries are empty.
TokenScene MixedScene() {
  TokenScene scene =
      TokensOfScene({ObjectAt("table", 0, 0, 0), ObjectAt("cup", 0.3, 0, kTableTop),
                     ObjectAt("cup", -0.3, 0, kTableTop), ObjectAt("cup", -0.25, 0, kTableTop),
                     ObjectAt("cup", 0, 0.3, kTableTop + 0.2)});
  SetFlags(TableVocabulary(), TableAssets(), {}, &scene);
  return scene;
}

TEST(MaskGenerator, FindsWhatIsToBeSampledAgain) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  const TokenScene scene = MixedScene();
  EXPECT_EQ(EmptyMask(vocabulary)->Mask(scene), (Flags{0, 0, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(PenetratingMask()->Mask(scene), (Flags{0, 0, 1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(UnstableMask()->Mask(scene), (Flags{0, 0, 0, 0, 1, 0, 0, 0}));
  const auto all = MaskNamed("empty,penetrating,unstable", vocabulary);
  EXPECT_EQ(all->Mask(scene), (Flags{0, 0, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(all->Name(), "empty,penetrating,unstable");
  EXPECT_EQ(MaskNamed("unstable", vocabulary)->Mask(scene), UnstableMask()->Mask(scene));
  EXPECT_THROW(MaskNamed("emtpy", vocabulary), core::Error);
  EXPECT_THROW(MaskNamed("", vocabulary), core::Error);
}

TEST(MaskGenerator, FindsTheSurplusOfAPrompt) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  const TokenScene scene = MixedScene();
  scene::Prompt prompt;
  prompt.kind = scene::PromptKind::kNames;
  prompt.names = {{"cup", 1}};
  EXPECT_EQ(SurplusMask(vocabulary, prompt)->Mask(scene), (Flags{0, 0, 1, 1, 1, 0, 0, 0}));
  prompt.names = {{"plate", 2}};
  EXPECT_EQ(SurplusMask(vocabulary, prompt)->Mask(scene), (Flags{0, 1, 1, 1, 1, 0, 0, 0}));
  prompt.and_others = true;
  EXPECT_EQ(SurplusMask(vocabulary, prompt)->Mask(scene), Flags(8, 0));
  prompt = {};
  prompt.kind = scene::PromptKind::kCount;
  prompt.count = 3;
  EXPECT_EQ(SurplusMask(vocabulary, prompt)->Mask(scene), (Flags{0, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(ContactGroups, JoinsWhatTouches) {
  const std::vector<scene::SceneObject> objects = {
      ObjectAt("cup", 0.3, 0, kTableTop), ObjectAt("table", 0, 0, 0),
      ObjectAt("plate", -0.3, 0, kTableTop), ObjectAt("cup", -0.3, 0, kTableTop + kPlateHeight),
      ObjectAt("cup", 0, 0.3, kTableTop)};
  EXPECT_EQ(ContactGroups(objects, TableAssets()), (std::vector<int>{0, -1, 1, 1, 2}));
}

TEST(SceneRepair, PlacesNewObjectsAmongKeptOnes) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  // New: a cup that penetrates a kept one, one that floats, and one beside the table.
  TokenScene scene =
      TokensOfScene({ObjectAt("table", 0, 0, 0), ObjectAt("cup", 0.3, 0, kTableTop),
                     ObjectAt("cup", 0.33, 0, kTableTop), ObjectAt("cup", 0, 0.3, kTableTop + 0.05),
                     ObjectAt("cup", 0.9, 0, kTableTop)});
  const TokenScene before = scene;
  RepairScene({0, 0, 1, 1, 1, 0, 0, 0}, vocabulary, TableAssets(), {}, &scene);
  const auto kept = static_cast<size_t>(2 * vocabulary.TokenWidth());
  EXPECT_TRUE(std::equal(before.tokens.begin(),
                         before.tokens.begin() + static_cast<std::ptrdiff_t>(kept),
                         scene.tokens.begin()))
      << "kept objects moved";
  EXPECT_EQ(scene.ObjectEntries(vocabulary), (std::vector<int>{0, 1, 2, 3}));
  const JudgedScene judged = Judge(scene.Judged(vocabulary).objects, TableAssets());
  EXPECT_EQ(judged.FeasibleCount(true), 4);
  EXPECT_EQ(scene.Judged(vocabulary).FeasibleCount(true), 4);
  const Eigen::Vector3d moved = judged.objects[2].world_from_object.translation();
  EXPECT_NEAR(moved.x(), 0.4, 2e-3);
  EXPECT_NEAR(judged.objects[3].world_from_object.translation().z(), kTableTop, 1e-3);
  EXPECT_TRUE(ConfirmScene(vocabulary, TableAssets(), {}, &scene));
}

TEST(SceneRepair, DropsWhatTopplesAKeptObject) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  // The kept plate overhangs the edge by less than half; a cup on its outer rim would topple it.
  TokenScene scene = TokensOfScene(
      {ObjectAt("table", 0, 0, 0), ObjectAt("plate", 0.57, 0, kTableTop),
       ObjectAt("cup", 0.66, 0, kTableTop + kPlateHeight), ObjectAt("cup", -0.3, 0, kTableTop)});
  RepairScene({0, 0, 1, 1, 0, 0, 0, 0}, vocabulary, TableAssets(), {}, &scene);
  EXPECT_EQ(scene.ObjectEntries(vocabulary), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(scene.Judged(vocabulary).FeasibleCount(true), 3);
}

TEST(SceneRepair, NoneJudgesSamplesAsTheyAre) {
  const TokenScene scene = MixedScene();
  TokenScene judged = scene;
  RepairOptions options;
  options.repair = Repair::kNone;
  RepairScene(Flags(8, 1), TableVocabulary(), TableAssets(), options, &judged);
  EXPECT_EQ(judged.tokens, scene.tokens);
  EXPECT_EQ(judged.penetrating, scene.penetrating);
  EXPECT_EQ(judged.unstable, scene.unstable);
}

TEST(SceneRepair, ConfirmFindsWhatIsNotStable) {
  TokenScene scene = MixedScene();
  scene.unstable.assign(8, 0);  // the floating cup is claimed to be stable
  EXPECT_FALSE(ConfirmScene(TableVocabulary(), TableAssets(), {}, &scene));
  EXPECT_EQ(scene.unstable, (Flags{0, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(SceneRepair, RefusesNumbersThatAreNotFinite) {
  TokenScene scene = MixedScene();
  scene.tokens[0] = NAN;
  EXPECT_THROW(RepairScene(Flags(8, 1), TableVocabulary(), TableAssets(), {}, &scene), core::Error);
}

}  // namespace
}  // namespace simwright::steering
