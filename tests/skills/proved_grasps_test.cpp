// Skills that grasp a rigid object by its proved grasps: ranking, plan, target frame and expert.
#include <gtest/gtest.h>

#include <numbers>

#include "core/files.h"
#include "manipulation/grasp_ranking.h"
#include "skills/scripted_expert.h"
#include "skills/skill_evaluation.h"
#include "skills/start_pool.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const Vector3d kBlock(0.12, 0.04, 0.16);  // m, too long for the gripper along x

// Returns a grasp of the block across y at the height `z` (m), 15 mm inside its near side, with the
// approach `pitch` (rad) below the x axis.
manipulation::Grasp SideGrasp(double z, double pitch, double quality) {
  manipulation::Grasp grasp;
  const Vector3d approach(std::cos(pitch), 0.0, -std::sin(pitch));
  const Vector3d across = Vector3d::UnitY();
  grasp.object_from_tool.linear() << across.cross(approach), across, approach;
  grasp.object_from_tool.translation() = Vector3d(-0.5 * kBlock.x() + 0.015, 0.0, z);
  grasp.width = kBlock.y();
  grasp.opening = kBlock.y() + 0.02;
  for (const size_t finger : {0u, 1u}) {
    const double side = finger == 0 ? -1.0 : 1.0;
    grasp.contacts[finger] =
        grasp.object_from_tool.translation() + side * 0.5 * kBlock.y() * across;
    grasp.normals[finger] = side * across;
  }
  grasp.clears_support = true;
  grasp.quality = quality;
  return grasp;
}

SkillSubtask PickUpBlock(const std::vector<manipulation::Grasp>& grasps) {
  SkillSubtask scene = PickUpCup();
  scene.assets = {WithInertia(tasks::Box("cup", kBlock, 0.2))};
  scene.subtask.goal = Vector3d(0.5, 0.0, 0.25);
  if (!grasps.empty()) scene.grasps["cup"] = grasps;
  return scene;
}

std::shared_ptr<const Skill> BlockSkill(const std::vector<manipulation::Grasp>& grasps) {
  return MakeSkill(robot::Panda(false), {PickUpBlock(grasps)}, SkillOptions().ForEvaluation());
}

// Returns the tool at the grasp configuration of a start, in the frame of the object.
Isometry3d PlannedGrasp(const Skill& skill, const StartState& start) {
  const SkillVariant& variant = skill.variants.front();
  return start.state.roots[0].inverse() * variant.subtask.start.world_from_robot *
         robot::ForwardKinematics(skill.robot->arm, start.grasp_configuration);
}

TEST(ProvedGrasps, TheMostPromisingThatTheArmMayApproachComeFirst) {
  manipulation::Grasp below = SideGrasp(0.08, -1.2, 1.0);
  manipulation::Grasp blocked = SideGrasp(0.02, 0.3, 1.0);
  blocked.clears_support = false;
  manipulation::Grasp backwards = SideGrasp(0.08, std::numbers::pi, 1.0);
  const auto skill = BlockSkill({below, SideGrasp(0.09, 0.6, 0.5), blocked, backwards,
                                 SideGrasp(0.085, 0.6, 1.0), SideGrasp(0.14, 1.4, 1.0)});
  const SkillVariant& variant = skill->variants.front();
  // The second lies within 2 cm and 30 degrees of the fifth, which survives more perturbations.
  std::vector<int> ranked = manipulation::RankGrasps(variant, variant.start);
  std::sort(ranked.begin(), ranked.end());
  EXPECT_EQ(ranked, (std::vector<int>{4, 5}));
  // A block that lies on its side does not stand on the plane that grasps are proved to clear.
  tasks::WorldState lying = variant.start;
  lying.roots[0].linear() = Eigen::AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix();
  const std::vector<int> tilted = manipulation::RankGrasps(variant, lying);
  EXPECT_NE(std::find(tilted.begin(), tilted.end(), 2), tilted.end());
}

TEST(ProvedGrasps, ThePlanTakesTheObjectByOneOfThem) {
  const std::vector<manipulation::Grasp> grasps = {SideGrasp(0.12, 0.4, 1.0)};
  const auto skill = BlockSkill(grasps);
  int taken = 0;
  for (const StartState& start : SampleStarts(*skill, 12, 5)) {
    if (start.grasp < 0) continue;
    ++taken;
    Isometry3d tool = PlannedGrasp(*skill, start);
    if (tool.linear()(1, 1) < 0.0) tool.linear().leftCols<2>() *= -1.0;  // the other half turn
    EXPECT_LT((tool.matrix() - grasps[0].object_from_tool.matrix()).norm(), 0.02);
    EXPECT_DOUBLE_EQ(OpeningFor(*skill, start), grasps[0].opening);
  }
  // An arm that cannot come from that side takes the object from above.
  EXPECT_GE(taken, 4);
  for (const StartState& start : SampleStarts(*BlockSkill({}), 4, 5)) {
    EXPECT_EQ(start.grasp, -1);
    EXPECT_LT(PlannedGrasp(*skill, start).linear()(2, 2), -0.7);
  }
}

TEST(ProvedGrasps, TheFrameTurnsWithTheObjectUntilItIsHeld) {
  const auto skill = BlockSkill({SideGrasp(0.12, 0.4, 1.0)});
  const SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  manipulation::TargetFrame frame(variant, state, Vector3d::UnitY(), 0.0, Vector3d::Zero(), 0);
  const Isometry3d root_from_target = state.roots[0].inverse() * frame.world_from_target();
  EXPECT_LT(
      (root_from_target.matrix() - variant.target->grasps[0].object_from_tool.matrix()).norm(),
      1e-9);
  state.roots[0].rotate(Eigen::AngleAxisd(0.4, Vector3d::UnitZ()));
  state.roots[0].translation() += Vector3d(0.03, -0.02, 0.0);
  frame.Update(state);
  EXPECT_LT(
      (frame.world_from_target().matrix() - (state.roots[0] * root_from_target).matrix()).norm(),
      1e-9);
  state.grasped = true;
  state.touched = 0;
  const Eigen::Matrix3d held = frame.world_from_target().linear();
  state.roots[0].rotate(Eigen::AngleAxisd(0.4, Vector3d::UnitZ()));
  frame.Update(state);
  EXPECT_LT((frame.world_from_target().linear() - held).norm(), 1e-9);
}

TEST(ProvedGrasps, TheScriptedExpertLiftsByThem) {
  const auto skill = BlockSkill({SideGrasp(0.12, 0.4, 1.0)});
  int tried = 0, lifted = 0;
  for (const StartState& start : SampleStarts(*skill, 24, 7)) {
    if (start.grasp < 0) continue;
    ++tried;
    Episode episode(*skill);
    const EvaluatedEpisode result = RunScriptedExpert(start, &episode);
    if (!result.success) continue;
    ++lifted;
    // The gripper still leans as the grasp does: 0.4 rad below the horizontal.
    EXPECT_NEAR(episode.state().gripper.linear()(2, 2), -std::sin(0.4), 0.15);
  }
  EXPECT_GE(tried, 8);
  EXPECT_GE(lifted, 0.8 * tried) << lifted << " of " << tried;
}

// Fingers press with 20 N on an eraser of 6 g: 300 times its weight.
TEST(ProvedGrasps, LightObjectsAreHeldWithoutSinkingIn) {
  SkillSubtask scene = PickUpCup();
  const double width = 0.03;
  scene.assets = {WithInertia(tasks::Box("cup", {0.05, width, 0.02}, 0.006))};
  int lifted[2] = {0, 0};
  for (const bool fine : {false, true}) {
    SkillOptions options = SkillOptions().ForEvaluation();
    options.mass = {1.0, 1.0};
    if (!fine) options.light_contact_iterations = options.contact_iterations;
    const auto skill = MakeSkill(robot::Panda(false), {scene}, options);
    for (const StartState& start : SampleStarts(*skill, 12, 3)) {
      Episode episode(*skill);
      if (!RunScriptedExpert(start, &episode).success) continue;
      ++lifted[fine];
      const double least = fine ? 0.95 * width : 0.0;
      EXPECT_GE(episode.state().opening, least);
    }
  }
  EXPECT_GE(lifted[1], 11);
  EXPECT_LT(lifted[0], lifted[1]);  // else the finer solver is not needed
}

TEST(ProvedGrasps, AStartKeepsItsGraspInItsFile) {
  const auto skill = BlockSkill({SideGrasp(0.12, 0.4, 1.0)});
  std::vector<StartState> starts = SampleStarts(*skill, 6, 5);
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "starts.jsonl";
  WriteStarts(starts, file);
  const std::vector<StartState> read = ReadStarts(file, *skill);
  ASSERT_EQ(read.size(), starts.size());
  for (size_t i = 0; i < starts.size(); ++i) EXPECT_EQ(read[i].grasp, starts[i].grasp);
  // A file of a skill with grasps does not fit one without.
  const auto bare = BlockSkill({});
  EXPECT_THROW(ReadStarts(file, *bare), core::Error);
}

}  // namespace
}  // namespace simwright::skills
