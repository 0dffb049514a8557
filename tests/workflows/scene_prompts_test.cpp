// The report of how well scenes agree with prompts names what does not hold.
#include "workflows/scenes/scene_prompts.h"

#include <gtest/gtest.h>

#include "scene/scene_types/scene_types.h"

namespace simwright::workflows {
namespace {

scene::SceneObject PlacedAt(const std::string& category, double y) {
  scene::SceneObject object;
  object.category = category;
  object.world_from_object = Eigen::Translation3d(0.0, y, 0.75) * Eigen::Isometry3d::Identity();
  return object;
}

TEST(ScenePrompts, ReportsNameTheStatementsThatDoNotHold) {
  scene::Prompt prompt{scene::PromptKind::kRelations, {}, {{"mug", 1}, {"bowl", 1}}, false, {}, {}};
  prompt.relations = {{{"mug", 0}, scene::Relation::kLeftOf, {"bowl", 0}},
                      {{"mug", 0}, scene::Relation::kInside, {"bowl", 0}}};
  const std::vector<std::vector<scene::SceneObject>> scenes = {
      {PlacedAt("mug", 0.3), PlacedAt("bowl", 0.0)},
      {PlacedAt("mug", -0.3), PlacedAt("bowl", 0.0)}};
  const std::vector<PromptReport> reports =
      ReportsOf({prompt}, scenes, scene::DefaultCategorySizes());
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].held, 0.25);
  ASSERT_EQ(reports[0].broken.size(), 2u);
  EXPECT_EQ(reports[0].broken[0].statement, "the mug is to the left of the bowl");
  EXPECT_EQ(reports[0].broken[0].scenes, 1);
  EXPECT_EQ(reports[0].broken[1].scenes, 2);
  const std::string table = PromptTable(reports);
  EXPECT_NE(table.find("does not hold in 1 of 2: the mug is to the left of the bowl"),
            std::string::npos)
      << table;
  EXPECT_EQ(PromptJson(reports)[0]["relations_broken"].size(), 2u);
}

// Scenes 0 and 2 belong to the first prompt, of which only scene 0 has all names, scenes 1 and 3 to
// the second, and have its name.
TEST(ScenePrompts, ReportsCountTheScenesWithEveryName) {
  const scene::Prompt cups{scene::PromptKind::kNames, {}, {{"mug", 2}, {"bowl", 1}}, true, {}, {}};
  const scene::Prompt mugs{scene::PromptKind::kNames, {}, {{"mug", 1}}, true, {}, {}};
  const std::vector<std::vector<scene::SceneObject>> scenes = {
      {PlacedAt("mug", 0.3), PlacedAt("bowl", 0.0)},
      {PlacedAt("mug", 0.0)},
      {PlacedAt("mug", 0.3), PlacedAt("mug", 0.0)},
      {PlacedAt("mug", 0.3), PlacedAt("bowl", 0.0)}};
  const std::vector<PromptReport> reports =
      ReportsOf({cups, mugs}, scenes, scene::DefaultCategorySizes());
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].complete, 1);
  EXPECT_EQ(reports[1].complete, 2);
  EXPECT_EQ(PromptJson(reports)[0]["scenes_with_every_name"], 1);
  // Agreement: (2 - 1 + 1) / 3 and 2 / 3 with the first prompt, 1 with the second.
  EXPECT_NE(PromptTable(reports).find(
                "all prompts: agreement 0.83, exact in 2 of 4, every name in 3 of 4"),
            std::string::npos)
      << PromptTable(reports);
}

}  // namespace
}  // namespace simwright::workflows
