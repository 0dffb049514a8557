// Configurations along a joint path, against the poses of the part, and an arm that keeps to them.
#include "manipulation/path_configurations.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "manipulation/collision_checker.h"
#include "manipulation/joint_target.h"
#include "skills/scripted_expert.h"
#include "skills/skill_evaluation.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr size_t kDoor = 0;  // the microwave, the only object

std::shared_ptr<const skills::Skill> PathConfigurationsMake(const skills::SkillSubtask& scene,
                                                            bool on_base) {
  return skills::MakeSkill(robot::Panda(on_base), {scene}, skills::SkillOptions().ForEvaluation());
}

size_t JointOf(const skills::SkillVariant& variant) {
  return static_cast<size_t>(variant.target->joint);
}

TEST(PathConfigurations, HaveTheToolAtThePartAllAlongItsWay) {
  const auto skill = PathConfigurationsMake(skills::OpenDoor(), false);
  const skills::SkillVariant& variant = skill->variants.front();
  core::Rng rng = core::StreamRng(3, 0);
  const auto plan = PlanReach(*skill, variant, variant.start, skill->robot->home(), rng);
  ASSERT_TRUE(plan);
  const PathConfigurations along = ConfigurationsAlongJoint(*skill, variant, variant.start,
                                                            plan->grasp_configuration, plan->pitch);
  ASSERT_EQ(along.positions.size(), along.configurations.size());
  const tasks::ObjectJoint& joint = variant.model.objects[kDoor].joints[JointOf(variant)];
  EXPECT_NEAR(along.positions.back(), JointTarget(joint, 0.0), 1e-12);
  tasks::WorldState state = variant.start;
  for (size_t i = 0; i < along.positions.size(); ++i) {
    state.joints[kDoor][JointOf(variant)] = along.positions[i];
    const Isometry3d tool = variant.subtask.start.world_from_robot *
                            robot::ForwardKinematics(skill->robot->arm, along.configurations[i]);
    const Isometry3d part = GraspPose(variant, state, tool.linear().col(1), plan->pitch);
    EXPECT_LT((tool.translation() - part.translation()).norm(), 0.011) << i;
    EXPECT_LT(Eigen::AngleAxisd(tool.linear().transpose() * part.linear()).angle(), 0.16) << i;
  }
}

TEST(PathConfigurations, AreInterpolatedBetweenAndKeptBeyond) {
  PathConfigurations along;
  along.positions = {1.0, 0.5, 0.0};  // of a part that is being shut
  for (const double value : {2.0, 4.0, 8.0}) {
    along.configurations.push_back(robot::JointVector::Constant(2, value));
  }
  EXPECT_EQ(along.At(1.2)[0], 2.0);
  EXPECT_NEAR(along.At(0.75)[0], 3.0, 1e-12);
  EXPECT_NEAR(along.At(0.5)[0], 4.0, 1e-12);
  EXPECT_NEAR(along.At(0.1)[1], 7.2, 1e-12);
  EXPECT_EQ(along.At(-0.3)[1], 8.0);
  std::reverse(along.positions.begin(), along.positions.end());
  EXPECT_NEAR(along.At(0.25)[0], 3.0, 1e-12);
}

TEST(PathConfigurations, ThereAreNoneOfAToolThatIsNotAtWork) {
  const auto door = PathConfigurationsMake(skills::OpenDoor(), false);
  const skills::SkillVariant& variant = door->variants.front();
  EXPECT_TRUE(ConfigurationsAlongJoint(*door, variant, variant.start, door->robot->home(), 0.0)
                  .positions.empty());
  const auto cup = PathConfigurationsMake(skills::PickUpCup(), false);
  const skills::SkillVariant& taken = cup->variants.front();
  EXPECT_TRUE(ConfigurationsAlongJoint(*cup, taken, taken.start, cup->robot->home(), 0.0)
                  .positions.empty());
}

// With two redundant joints of a base, an arm that drifts home while it pulls would fold itself up.
TEST(PathConfigurations, AnArmKeepsToThemWhileItPulls) {
  const auto skill = PathConfigurationsMake(skills::OpenDoor(), true);
  skills::Episode episode(*skill);
  int opened = 0;
  for (const skills::StartState& start : skills::SampleStarts(*skill, 10, 5)) {
    episode.Begin(start);
    const skills::SkillVariant& variant = skill->variants.front();
    const PathConfigurations along = ConfigurationsAlongJoint(
        *skill, variant, start.state, start.grasp_configuration, start.pitch);
    ASSERT_FALSE(along.positions.empty());
    std::vector<float> action(7);
    skills::Decision decision;
    while (!decision.terminated && !decision.truncated) {
      skills::ExpertAction(episode, action.data());
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
  const auto skill = PathConfigurationsMake(skills::CloseDoor(), false);
  const skills::SkillVariant& variant = skill->variants.front();
  const tasks::ObjectJoint& joint = variant.model.objects[kDoor].joints[JointOf(variant)];
  skills::Episode episode(*skill);
  int in_two = 0, shut = 0, shut_in_two = 0, tried = 0;
  for (skills::StartState start : skills::SampleStarts(*skill, 24, 5)) {
    start.state.joints[kDoor][JointOf(variant)] = joint.upper;
    start.arm = skill->robot->home();
    if (!IsArmCollisionFree(*skill, variant, start.state, start.arm)) continue;
    core::Rng rng = core::StreamRng(7, static_cast<std::uint64_t>(tried++));
    const skills::StartState next =
        skills::PlannedFrom(*skill, start, rng, skills::Resampling::kNothing);
    const bool two =
        ConfigurationsAlongJoint(*skill, variant, next.state, next.grasp_configuration, next.pitch)
            .ends_early;
    const skills::EvaluatedEpisode result = skills::RunScriptedExpert(next, &episode);
    in_two += two;
    shut += result.success;
    shut_in_two += two && result.success;
  }
  EXPECT_GE(in_two, 3);
  EXPECT_GE(shut_in_two, 1);
  EXPECT_GE(shut, tried / 2);
}

}  // namespace
}  // namespace simwright::manipulation
