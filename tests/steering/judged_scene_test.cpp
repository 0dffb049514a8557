// The result of physics for each object of a scene.
#include "steering/rewards/judged_scene.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/steering/steering_scenes.h"

namespace simwright::steering {
namespace {

TEST(JudgedScene, TellsPenetratingUnstableAndFeasibleObjectsApart) {
  // Cups that stand, that penetrate each other by 1.5 and by 0.5 mm, one in the air, one that
  // balances on the rim with its center outside, and a plate that is pressed into the table.
  const double radius = 0.05 * std::cos(M_PI / 24.0);  // of the prism's flat sides
  const std::vector<scene::SceneObject> objects = {
      ObjectAt("table", 0, 0, 0),
      ObjectAt("cup", 0.3, 0.3, kTableTop),
      ObjectAt("cup", 0, 0, kTableTop),
      ObjectAt("cup", 0, 0.0985 * radius / 0.05, kTableTop),
      ObjectAt("cup", -0.3, 0, kTableTop + 0.05),
      ObjectAt("cup", 0.62, 0, kTableTop),
      ObjectAt("plate", 0, -0.4, kTableTop - 0.0015),
      ObjectAt("plate", -0.3, -0.3, kTableTop - 0.0005)};
  const JudgedScene judged = Judge(objects, TableAssets());
  EXPECT_EQ(judged.penetrating, (std::vector<char>{0, 0, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(judged.unstable, (std::vector<char>{0, 0, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(judged.FeasibleCount(false), 2);
  EXPECT_EQ(judged.FeasibleCount(true), 3);
}

TEST(JudgedScene, RemovesPenetratingObjectsBeforeItWatchesTheOthers) {
  // The upper cup stands on one that penetrates the table: once that is removed, it falls.
  const JudgedScene judged =
      Judge({ObjectAt("table", 0, 0, 0), ObjectAt("cup", 0, 0, kTableTop - 0.01),
             ObjectAt("cup", 0, 0, kTableTop - 0.01 + kCupHeight)},
            TableAssets());
  EXPECT_EQ(judged.penetrating, (std::vector<char>{0, 1, 0}));
  EXPECT_EQ(judged.unstable, (std::vector<char>{0, 0, 1}));
}

TEST(JudgedScene, FollowsFreeFall) {
  // In 0.1 s an object falls by g t^2 / 2 = 49 mm.
  const std::vector<scene::SceneObject> objects = {ObjectAt("table", 0, 0, 0),
                                                   ObjectAt("cup", 0, 0, kTableTop + 0.2)};
  JudgingOptions options;
  options.displacement = 0.047;
  EXPECT_TRUE(Judge(objects, TableAssets(), options).unstable[1]);
  options.displacement = 0.051;
  EXPECT_FALSE(Judge(objects, TableAssets(), options).unstable[1]);
}

TEST(JudgedScene, RefusesInvalidInput) {
  JudgingOptions options;
  options.duration = 0.0;
  EXPECT_THROW(Judge({ObjectAt("table", 0, 0, 0)}, TableAssets(), options), core::Error);
  EXPECT_THROW(Judge({ObjectAt("sofa", 0, 0, 0)}, TableAssets()), core::Error);
  EXPECT_THROW(Judge({ObjectAt("cup", std::nan(""), 0, 1)}, TableAssets()), core::Error);
}

}  // namespace
}  // namespace simwright::steering
