// Configurations along a joint path, against the poses of the part, and an arm that keeps to them.
#include "rl/work_postures.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "rl/arm_clearance.h"
#include "rl/joint_work.h"
#include "rl/scripted_hand.h"
#include "rl/skill_evaluation.h"
#include "tests/rl/skill_scene.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr size_t kDoor = 0;  // the microwave, the only object

std::shared_ptr<const Skill> Make(const SkillSubtask& scene, bool on_base) {
  return MakeSkill(robot::Panda(on_base), {scene}, SkillOptions().ForEvaluation());
}

size_t JointOf(const SkillVariant& variant) {
  return static_cast<size_t>(variant.focus->joint);
}

TEST(WorkPostures, HaveTheToolAtThePartAllAlongItsWay) {
  const auto skill = Make(OpenDoor(), false);
  const SkillVariant& variant = skill->variants.front();
  core::Rng rng = core::StreamRng(3, 0);
  const auto plan = PlanReach(*skill, variant, variant.start, skill->robot->home(), rng);
  ASSERT_TRUE(plan);
  const WorkPostures along =
      PosturesAlong(*skill, variant, variant.start, plan->at_work, plan->pitch);
  ASSERT_EQ(along.positions.size(), along.postures.size());
  const tasks::ThingJoint& joint = variant.model.things[kDoor].joints[JointOf(variant)];
  EXPECT_NEAR(along.positions.back(), WorkEnd(joint, 0.0), 1e-12);
  tasks::SceneState state = variant.start;
  for (size_t i = 0; i < along.positions.size(); ++i) {
    state.joints[kDoor][JointOf(variant)] = along.positions[i];
    const Isometry3d tool = variant.subtask.start.world_from_robot *
                            robot::ForwardKinematics(skill->robot->arm, along.postures[i]);
    const Isometry3d part = ToolAtFocus(variant, state, tool.linear().col(1), plan->pitch);
    EXPECT_LT((tool.translation() - part.translation()).norm(), 0.011) << i;
    EXPECT_LT(Eigen::AngleAxisd(tool.linear().transpose() * part.linear()).angle(), 0.16) << i;
  }
}

TEST(WorkPostures, AreInterpolatedBetweenAndKeptBeyond) {
  WorkPostures along;
  along.positions = {1.0, 0.5, 0.0};  // of a part that is being shut
  for (const double value : {2.0, 4.0, 8.0}) {
    along.postures.push_back(robot::Posture::Constant(2, value));
  }
  EXPECT_EQ(along.At(1.2)[0], 2.0);
  EXPECT_NEAR(along.At(0.75)[0], 3.0, 1e-12);
  EXPECT_NEAR(along.At(0.5)[0], 4.0, 1e-12);
  EXPECT_NEAR(along.At(0.1)[1], 7.2, 1e-12);
  EXPECT_EQ(along.At(-0.3)[1], 8.0);
  std::reverse(along.positions.begin(), along.positions.end());
  EXPECT_NEAR(along.At(0.25)[0], 3.0, 1e-12);
}

TEST(WorkPostures, ThereAreNoneOfAToolThatIsNotAtWork) {
  const auto door = Make(OpenDoor(), false);
  const SkillVariant& variant = door->variants.front();
  EXPECT_TRUE(
      PosturesAlong(*door, variant, variant.start, door->robot->home(), 0.0).positions.empty());
  const auto cup = Make(PickUpCup(), false);
  const SkillVariant& taken = cup->variants.front();
  EXPECT_TRUE(PosturesAlong(*cup, taken, taken.start, cup->robot->home(), 0.0).positions.empty());
}

// With two redundant joints of a base, an arm that drifts home while it pulls would fold itself up.
TEST(WorkPostures, AnArmKeepsToThemWhileItPulls) {
  const auto skill = Make(OpenDoor(), true);
  Episode episode(*skill);
  int opened = 0;
  for (const EpisodeStart& start : DrawStarts(*skill, 10, 5)) {
    episode.Begin(start);
    const SkillVariant& variant = skill->variants.front();
    const WorkPostures along =
        PosturesAlong(*skill, variant, start.state, start.at_work, start.pitch);
    ASSERT_FALSE(along.positions.empty());
    std::vector<float> action(7);
    Decision decision;
    while (!decision.terminated && !decision.truncated) {
      ScriptedAction(episode, action.data());
      decision = episode.Step(action.data());
    }
    if (!decision.terminated) continue;
    ++opened;
    Eigen::VectorXd arm;
    episode.world().robot().Positions(&arm);
    const double position = episode.state().joints[kDoor][JointOf(variant)];
    EXPECT_LT((arm - along.At(position)).lpNorm<Eigen::Infinity>(), 0.25);
  }
  EXPECT_GE(opened, 7);
}

// An arm after another skill, the door at its stop: from some poses no arm shuts it with one plan.
TEST(Episode, ADoorAtItsStopIsShutInTwoPlans) {
  const auto skill = Make(CloseDoor(), false);
  const SkillVariant& variant = skill->variants.front();
  const tasks::ThingJoint& joint = variant.model.things[kDoor].joints[JointOf(variant)];
  Episode episode(*skill);
  int in_two = 0, shut = 0, shut_in_two = 0, tried = 0;
  for (EpisodeStart start : DrawStarts(*skill, 24, 5)) {
    start.state.joints[kDoor][JointOf(variant)] = joint.upper;
    start.arm = skill->robot->home();
    if (!IsArmClear(*skill, variant, start.state, start.arm)) continue;
    core::Rng rng = core::StreamRng(7, static_cast<std::uint64_t>(tried++));
    const EpisodeStart next = Varied(*skill, start, rng, VariedParts::kNothing);
    const bool two =
        PosturesAlong(*skill, variant, next.state, next.at_work, next.pitch).ends_early;
    const EvaluatedEpisode result = RunScript(next, &episode);
    in_two += two;
    shut += result.success;
    shut_in_two += two && result.success;
  }
  EXPECT_GE(in_two, 3);
  EXPECT_GE(shut_in_two, 1);
  EXPECT_GE(shut, tried / 2);
}

}  // namespace
}  // namespace simwright::rl
