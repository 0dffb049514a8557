// The scene type of prompted samples, and what is said about other types that a prompt names.
#include "workflows/scenes/scene_type_choice.h"

#include <gtest/gtest.h>

namespace simwright::workflows {
namespace {

scene::SceneModelMetadata ModelOf(const std::vector<std::string>& types) {
  const scene::PoseRange range({}, {});
  scene::SceneModelMetadata metadata{{types.front(), 10, {}, {}}, {}, range};
  if (types.size() == 1) return metadata;
  for (const std::string& type : types) {
    metadata.types.push_back({type, 10, range, 0, 0, {"apple"}});
  }
  return metadata;
}

RequestedPrompts Naming(const std::string& type) {
  RequestedPrompts prompts;
  prompts.prompts.emplace_back();
  prompts.types = {type};
  return prompts;
}

TEST(SceneTypeChoice, TakesTheNamedType) {
  core::Findings findings;
  const scene::SceneModelMetadata both = ModelOf({"dimsum", "pantry_shelf"});
  EXPECT_EQ(ChooseSceneType(both, "", Naming("pantry_shelf"), &findings), "pantry_shelf");
  EXPECT_EQ(ChooseSceneType(ModelOf({"dimsum"}), "", Naming("dimsum"), &findings), "dimsum");
  EXPECT_TRUE(findings.empty());
}

TEST(SceneTypeChoice, SaysThatAnotherNamedTypeIsIgnored) {
  const auto expect = [](const scene::SceneModelMetadata& model, const std::string& asked,
                         const std::string& chosen) {
    core::Findings findings;
    EXPECT_EQ(ChooseSceneType(model, asked, Naming("dimsum"), &findings), chosen);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].code, "scene-type-ignored");
    EXPECT_NE(findings[0].sentence.find("dimsum"), std::string::npos);
  };
  expect(ModelOf({"pantry_shelf"}), "", "pantry_shelf");
  expect(ModelOf({"pantry_shelf"}), "pantry_shelf", "pantry_shelf");
  expect(ModelOf({"dimsum", "pantry_shelf"}), "pantry_shelf", "pantry_shelf");
}

TEST(SceneTypeChoice, ReadsTheTypesOfTheModelFirst) {
  const std::vector<std::string> types = TypesToRead(ModelOf({"restaurant_low"}));
  EXPECT_EQ(types.front(), "restaurant_low");
  EXPECT_EQ(types.size(), 7u);
}

}  // namespace
}  // namespace simwright::workflows
