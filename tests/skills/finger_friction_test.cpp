// The friction of the fingers is sampled for each episode, which begins with the sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "skill_scene.h"
#include "skills/skill_evaluation.h"
#include "skills/start_pool.h"

namespace simwright::skills {
namespace {

SkillOptions With(std::optional<FactorRange> friction) {
  SkillOptions options = SkillOptions().ForEvaluation();
  options.finger_friction = friction;
  return options;
}

TEST(FingerFriction, IsDrawnEvenlyInItsLogarithmAndNothingElseChanges) {
  const auto drawn = MakeSkill(robot::Panda(false), {PickUpCup()}, With(FactorRange{0.8, 2.0}));
  const auto own = MakeSkill(robot::Panda(false), {PickUpCup()}, With(std::nullopt));
  const std::vector<StartState> starts = SampleStarts(*drawn, 200, 3);
  const std::vector<StartState> as_built = SampleStarts(*own, 200, 3);
  double low = 10.0, high = 0.0, below = 0.0;
  for (size_t i = 0; i < starts.size(); ++i) {
    ASSERT_TRUE(starts[i].finger_friction);
    EXPECT_FALSE(as_built[i].finger_friction);
    EXPECT_EQ(starts[i].mass, as_built[i].mass);
    EXPECT_EQ(starts[i].friction, as_built[i].friction);
    EXPECT_EQ(starts[i].delay, as_built[i].delay);
    EXPECT_EQ(starts[i].arm, as_built[i].arm);
    low = std::min(low, *starts[i].finger_friction);
    high = std::max(high, *starts[i].finger_friction);
    below += *starts[i].finger_friction < std::sqrt(0.8 * 2.0);
  }
  EXPECT_GE(low, 0.8);
  EXPECT_LT(low, 0.85);
  EXPECT_LE(high, 2.0);
  EXPECT_GT(high, 1.9);
  EXPECT_NEAR(below / 200.0, 0.5, 0.12);  // three standard deviations are 0.106
}

TEST(FingerFriction, IsKeptWithAStart) {
  const auto skill = MakeSkill(robot::Panda(false), {PickUpCup()}, With(FactorRange{0.8, 2.0}));
  const StartState start = SampleStarts(*skill, 1, 3).front();
  const StartState read = ParseStart(StartText(start), *skill, "here");
  EXPECT_EQ(read.finger_friction, start.finger_friction);
  StartState own = start;
  own.finger_friction.reset();
  EXPECT_FALSE(ParseStart(StartText(own), *skill, "here").finger_friction);
}

// An object of 0.1 to 0.4 kg with a friction of 0.42 to 0.78 needs 0.03 to 0.23 of fingers that
// press with 20 N each, more while it moves: with 0.02 hardly any is grasped, with 2 nearly all.
TEST(FingerFriction, DecidesWhatAHandCanHold) {
  const auto successes = [](double friction) {
    const auto skill =
        MakeSkill(robot::Panda(false), {PickUpCup()}, With(FactorRange{friction, friction}));
    return EvaluateScriptedExpert(*skill, SampleStarts(*skill, 20, 4)).successes;
  };
  EXPECT_LE(successes(0.02), 1);
  EXPECT_GE(successes(2.0), 17);
}

TEST(FingerFriction, ARangeThatIsNoneIsRefused) {
  std::string error;
  EXPECT_FALSE(With(FactorRange{0.0, 1.0}).IsValid(&error));
  EXPECT_NE(error.find("finger_friction"), std::string::npos) << error;
  EXPECT_FALSE(With(FactorRange{2.0, 1.0}).IsValid(&error));
  EXPECT_TRUE(With(FactorRange{1.0, 1.0}).IsValid(&error));
  EXPECT_TRUE(With(std::nullopt).IsValid(&error));
}

}  // namespace
}  // namespace simwright::skills
