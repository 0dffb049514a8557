// Grippers in side-opening receptacles: detecting a microwave's, placing a cup in it, grasping the
// cup before, entering, and retreating. Against the microwave's own numbers.
#include "manipulation/side_receptacle.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "manipulation/goal_displacement.h"
#include "manipulation/gripper_penetration.h"
#include "manipulation/reach_plan.h"
#include "manipulation/target_frame.h"
#include "skills/downstream_reachability.h"
#include "skills/skill_environment.h"
#include "skills/start_pool.h"
#include "skills/variant_reward.h"
#include "tasks/rules/rule_tasks.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Its body is 0.4 deep, its walls are 2 cm, its opening faces -x (tests/tasks/household.h).
constexpr double kHalfDepth = 0.2, kFloor = 0.02, kCell = 0.5 / 40;

tasks::WorldModel Kitchen() {
  return tasks::MakeWorldModel({skills::WithInertia(tasks::Microwave()),
                                skills::WithInertia(tasks::Cup()),
                                skills::WithInertia(tasks::DrawerUnit())});
}

tasks::WorldState SideReceptacleAt(const tasks::WorldModel& model, const Isometry3d& microwave) {
  tasks::InitialState start;
  start.placements = {{"microwave", microwave, true}};
  return tasks::StateOf(model, start);
}

// A rotated microwave, and its receptacle.
struct TurnedKitchen {
  tasks::WorldModel model = Kitchen();
  Isometry3d pose = Eigen::Translation3d(0.8, 0.1, 0.0) *
                    Eigen::AngleAxisd(0.5, Vector3d::UnitZ()) * Isometry3d::Identity();
  tasks::WorldState state = SideReceptacleAt(model, pose);
  std::optional<SideReceptacle> room =
      FindSideReceptacle(model, state, 0, model.objects[0].FindLink("body"));
};

// Returns the rules' own task, its subtasks each with the next one: open, pick up, put into, close.
std::vector<skills::SkillSubtask> PutCupIntoMicrowave() {
  const std::vector<assets::SemanticModel> assets = {skills::WithInertia(tasks::Microwave()),
                                                     skills::WithInertia(tasks::Cup())};
  tasks::RuleOptions options;
  options.count = 20;
  const tasks::RuleTasks made = tasks::GenerateTasksByRules(tasks::MakeWorldModel(assets), options);
  std::vector<skills::SkillSubtask> scenes;
  for (const tasks::Task& task : made.tasks) {
    if (task.name != "put_cup_into_microwave_and_close_it") continue;
    for (size_t k = 0; k < task.subtasks.size(); ++k) {
      skills::SkillSubtask& scene = scenes.emplace_back();
      scene.assets = assets;
      scene.subtask = task.subtasks[k];
      if (k + 1 < task.subtasks.size()) scene.next = task.subtasks[k + 1];
    }
  }
  return scenes;
}

std::shared_ptr<const skills::Skill> SideReceptacleMake(const skills::SkillSubtask& scene) {
  return skills::MakeSkill(robot::Panda(true), {scene}, skills::SkillOptions().ForEvaluation());
}

Isometry3d ToolAt(const skills::Skill& skill, const robot::JointVector& arm) {
  return skill.variants.front().subtask.start.world_from_robot *
         robot::ForwardKinematics(skill.robot->arm, arm);
}

TEST(SideReceptacle, IsWhatOpensToASide) {
  const TurnedKitchen kitchen;
  const auto& [model, pose, state, room] = kitchen;
  ASSERT_TRUE(room);
  EXPECT_LT((InwardDirection(*room, model, state) - pose.linear().col(0)).norm(), 1e-12);
  const Vector3d inside = pose * Vector3d(-kHalfDepth + 0.07, 0.1, 0.1);
  EXPECT_NEAR(DepthIn(*room, model, state, inside), 0.07, kCell);
  EXPECT_NEAR(DepthIn(*room, model, state, pose * Vector3d(-kHalfDepth - 0.1, 0.3, 0.1)), -0.1,
              kCell);
  const auto around = FindSideReceptacleAround(model, state, inside);
  ASSERT_TRUE(around);
  EXPECT_EQ(around->object, 0);
  EXPECT_FALSE(FindSideReceptacleAround(model, state, pose * Vector3d(0.0, 0.0, 0.4)));
  // Cups and drawers open upwards; so does a microwave that lies on its back.
  EXPECT_FALSE(FindSideReceptacle(model, state, 1, 0));
  EXPECT_FALSE(FindSideReceptacle(model, state, 2, model.objects[2].FindLink("drawer")));
  Isometry3d on_its_back = pose;
  on_its_back.rotate(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  EXPECT_FALSE(FindSideReceptacle(model, SideReceptacleAt(model, on_its_back), 0,
                                  model.objects[0].FindLink("body")));
}

TEST(SideReceptacle, AThingGoesJustBehindTheOpening) {
  const TurnedKitchen kitchen;
  const auto& [model, pose, state, room] = kitchen;
  ASSERT_TRUE(room);
  const Vector3d spot = pose * PlacementBehindOpening(*room, model, state, {0.08, 0.06, 0.1});
  EXPECT_NEAR(DepthIn(*room, model, state, spot), 0.04 + 0.03, 1e-9);
  EXPECT_NEAR((pose.inverse() * spot).y(), 0.0, kCell);
  EXPECT_NEAR(spot.z(), kFloor + 0.05 + 0.01, 2 * kCell);
  // An object deeper than the receptacle is placed at its middle.
  const Vector3d deep = pose * PlacementBehindOpening(*room, model, state, {0.8, 0.06, 0.1});
  EXPECT_NEAR((pose.inverse() * deep).x(), room->box.center().x(), 1e-9);
}

TEST(SideReceptacle, AThingThatGoesIntoOneIsTakenByAHandThatLeansIn) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto opens = SideReceptacleMake(scenes[0]), picks = SideReceptacleMake(scenes[1]),
             puts = SideReceptacleMake(scenes[2]);
  EXPECT_FALSE(opens->variants[0].next || opens->variants[0].room);
  ASSERT_TRUE(picks->variants[0].next && picks->variants[0].room);
  ASSERT_TRUE(puts->variants[0].room && puts->variants[0].destination->room);
  skills::SkillSubtask alone = scenes[1];
  alone.next.reset();
  const auto picks_alone = SideReceptacleMake(alone);
  EXPECT_FALSE(picks_alone->variants[0].next || picks_alone->variants[0].room);
  core::Rng rng = core::StreamRng(1, 0);
  const skills::SkillVariant& variant = picks->variants[0];
  int leaning = 0;
  for (int i = 0; i < 16; ++i) {
    const skills::StartState start = skills::SampleStart(*picks, rng);
    const Vector3d inward = InwardDirection(*variant.room, variant.model, start.state);
    const Isometry3d tool = ToolAt(*picks, start.grasp_configuration);
    EXPECT_NEAR(std::abs(PitchOf(tool)), std::abs(start.pitch), 0.02);
    EXPECT_LT(ToolAt(*picks_alone, skills::SampleStart(*picks_alone, rng).grasp_configuration)
                  .linear()
                  .col(2)
                  .z(),
              -0.7);
    if (tool.linear().col(2).dot(inward) < std::sin(0.5)) continue;
    ++leaning;
    // The closing axis is across the opening, as far as the cup's eight sides permit.
    EXPECT_LT(std::abs(tool.linear().col(1).dot(inward)), std::sin(M_PI / 8 + 0.06)) << i;
  }
  EXPECT_GE(leaning, 12);  // if the door leaves the arm no such path, it is at least grasped
}

TEST(SideReceptacle, AHandThatLeansIsClearInIt) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto skill = SideReceptacleMake(scenes[2]);
  const skills::SkillVariant& variant = skill->variants[0];
  const SurfacePoints hand = GripperSurface(*skill->robot, 0.016);
  core::Rng rng = core::StreamRng(2, 0);
  for (int i = 0; i < 8; ++i) {
    const skills::StartState start = skills::SampleStart(*skill, rng);
    EXPECT_EQ(start.held, variant.target->object);
    Isometry3d there = ToolAt(*skill, start.grasp_configuration);
    there.translation() += manipulation::DisplacementToDestination(variant, start.state);
    const std::vector<Isometry3d> links =
        WorldLinkPoses(variant.model.objects[0], start.state.roots[0], start.state.joints[0]);
    EXPECT_LT(PenetrationIntoBody(hand, there, variant.solids[0], links), 1e-3) << i;
    // Straight from above it would be in the ceiling.
    there.linear() =
        (Eigen::AngleAxisd(start.pitch, there.linear().col(1)).inverse() * there.linear()).eval();
    EXPECT_GT(PenetrationIntoBody(hand, there, variant.solids[0], links), 1e-3) << i;
  }
}

TEST(SideReceptacle, InsideIsWhereTheDoorClosesBehindIt) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto skill = SideReceptacleMake(scenes[2]);
  const skills::SkillVariant& variant = skill->variants[0];
  const double radius = 0.035 * 1.01;  // slightly more for its octagon
  skills::VariantReward reward(variant);
  const auto succeeds = [&](double behind) {
    tasks::WorldState state = variant.start;
    const Vector3d inward = InwardDirection(*variant.room, variant.model, state);
    Isometry3d& cup = state.roots[static_cast<size_t>(variant.target->object)];
    cup.translation() += manipulation::DisplacementToDestination(variant, state);
    const Vector3d now = tasks::LinkPosition(variant.model, state, variant.target->object, 0);
    cup.translation() += (behind - DepthIn(*variant.room, variant.model, state, now)) * inward;
    state.grasped = false;
    bool success = false;
    reward.Run(state, state, 0.05, &success);
    return success;
  };
  EXPECT_FALSE(succeeds(-0.05));
  EXPECT_FALSE(succeeds(radius - 0.02));
  EXPECT_TRUE(succeeds(radius + 0.02));  // the placement of DestinationOf
  EXPECT_TRUE(succeeds(0.2));
}

TEST(SideReceptacle, AHandThatIsLeftInsideGetsOutFirst) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto puts = SideReceptacleMake(scenes[2]), closes = SideReceptacleMake(scenes[3]);
  const skills::SkillVariant& variant = puts->variants[0];
  core::Rng rng = core::StreamRng(3, 0);
  skills::StartState end = skills::SampleStart(*puts, rng);
  Isometry3d there = ToolAt(*puts, end.grasp_configuration);
  const Vector3d displacement = manipulation::DisplacementToDestination(variant, end.state);
  there.translation() += displacement;
  const robot::PoseSolution found = puts->kinematics->Solve(
      variant.subtask.start.world_from_robot.inverse() * there, end.grasp_configuration, rng);
  ASSERT_TRUE(found.reached);
  end.arm = found.q;
  end.held = -1;
  end.state.roots[static_cast<size_t>(variant.target->object)].translation() += displacement;
  const skills::StartState start =
      skills::PlannedFrom(*closes, end, rng, skills::Resampling::kNothing);
  const Vector3d refuge = there.translation() + start.retreat;
  EXPECT_GE(start.retreat.norm(), 0.08 - 1e-9);
  EXPECT_LE(DepthIn(*variant.room, variant.model, end.state, refuge), -kEntryDistance + 2e-3);
  EXPECT_GT(-there.linear().col(2).dot(start.retreat.normalized()), 0.99);
  // An action of zero moves it there, in less time than the longest retreat, and then to the
  // handle.
  skills::Episode episode(*closes);
  episode.Begin(start);
  const float nothing[7] = {0, 0, 0, 0, 0, 0, 1.0f};
  double nearest = 1.0;
  for (int step = 0; step < 30; ++step) {
    episode.Step(nothing);
    nearest = std::min(nearest, (episode.state().gripper.translation() - refuge).norm());
  }
  EXPECT_LT(nearest, 0.03);
  // The file of start states keeps the retreat.
  const skills::StartState read = skills::ParseStart(skills::StartText(start), *closes, "test");
  EXPECT_EQ(skills::StartText(read), skills::StartText(start));
  EXPECT_EQ(read.retreat, start.retreat);
}

TEST(SideReceptacle, TheFrameIsTheRefugeUntilTheHandIsThere) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::OpenDoor()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  const Vector3d displacement(0.0, 0.0, 0.1);
  const TargetFrame grasp_configuration(variant, state, Vector3d::UnitY(), 0.0);
  TargetFrame frame(variant, state, Vector3d::UnitY(), 0.0, displacement);
  const Isometry3d next = Eigen::Translation3d(0.6 * displacement) * state.gripper;  // 6 cm ahead
  ASSERT_TRUE(frame.retreating());
  EXPECT_TRUE(frame.motion_direction().isZero());
  frame.Update(state);
  EXPECT_TRUE(frame.world_from_target().isApprox(next, 1e-12));
  state.gripper.translation() += 0.85 * displacement;
  frame.Update(state);
  EXPECT_FALSE(frame.retreating());
  EXPECT_TRUE(frame.world_from_target().isApprox(grasp_configuration.world_from_target(), 1e-12));
  // A blocked gripper continues after half a second, a slow one after one and a half.
  for (const double step : {0.0, 0.004}) {
    state = variant.start;
    TargetFrame slow(variant, state, Vector3d::UnitY(), 0.0, 5.0 * displacement);
    int updates = 0;
    while (slow.retreating() && updates < 100) {
      state.gripper.translation().z() += step;
      slow.Update(state);
      ++updates;
    }
    EXPECT_NEAR(updates, step > 0.0 ? 30 : 10, 2);
  }
}

TEST(SideReceptacle, AThingInTheHandGoesInThroughTheOpening) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto skill = SideReceptacleMake(scenes[2]);
  const skills::SkillVariant& variant = skill->variants[0];
  core::Rng rng = core::StreamRng(4, 0);
  const skills::StartState start = skills::SampleStart(*skill, rng);
  const Isometry3d tool = ToolAt(*skill, start.grasp_configuration);
  tasks::WorldState state = start.state;
  state.gripper = tool;
  const TargetFrame frame(variant, state, tool.linear().col(1), start.pitch);
  const Vector3d inward = InwardDirection(*variant.room, variant.model, state);
  EXPECT_LT((frame.world_from_target().linear() * frame.back() + inward).norm(), 1e-9);
  const double depth =
      DepthIn(*variant.room, variant.model, state, frame.world_from_target().translation());
  EXPECT_NEAR(frame.retreat_distance(), depth + kEntryDistance, 1e-9);
  // Returns the commanded pose in the target frame, with the tool off by `off`.
  skills::ActionFrame work;
  work.back = frame.back();
  work.retreat_distance = frame.retreat_distance();
  const float nothing[7] = {0, 0, 0, 0, 0, 0, 0};
  const Eigen::Matrix3d base_from_world =
      variant.subtask.start.world_from_robot.linear().transpose();
  const auto sent_to = [&](const Vector3d& off) -> Vector3d {
    skills::ArmCommand command;
    command.sent = start.grasp_configuration;
    const Isometry3d now = robot::ForwardKinematics(skill->robot->arm, command.sent);
    work.base_from_target.linear() = base_from_world * frame.world_from_target().linear();
    work.base_from_target.translation() = now.translation() - base_from_world * off;
    const Isometry3d target = skills::ActionTarget(*skill, nothing, work, command).base_from_tool;
    return base_from_world.transpose() *
           (target.translation() - work.base_from_target.translation());
  };
  const Vector3d aside = inward.cross(Vector3d::UnitZ()),
                 before = -frame.retreat_distance() * inward;
  EXPECT_LT(sent_to(-0.3 * inward).norm(), 1e-6);
  EXPECT_LT(sent_to(-0.3 * inward + 0.02 * aside).norm(), 1e-6);
  // Beside the opening: to in front of it. Beside the receptacle: straight back first, since its
  // wall is between.
  EXPECT_LT((sent_to(0.3 * aside + before) - before).norm(), 1e-6);
  EXPECT_LT((sent_to(0.3 * aside) - (0.3 * aside + before)).norm(), 1e-6);
}

TEST(SideReceptacle, OverARimAHandComesFromAbove) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  skills::SkillVariant variant = SideReceptacleMake(scenes[1])->variants.front();
  const Vector3d inward = InwardDirection(*variant.room, variant.model, variant.start);
  const Vector3d inside = variant.start.roots[0] * Vector3d(-kHalfDepth + 0.07, 0.0, 0.1);
  const double depth = DepthIn(*variant.room, variant.model, variant.start, inside);
  variant.target->rim = 0.0;
  const Vector3d straight = DisplacementOutOfReceptacle(variant, variant.start, inside);
  EXPECT_LT((straight + (depth + kEntryDistance) * inward).norm(), 1e-9);
  variant.target->rim = 0.03;
  const Vector3d over = DisplacementOutOfReceptacle(variant, variant.start, inside);
  EXPECT_NEAR((over - straight).head<2>().norm(), 0.0, 1e-9);
  // A finger that is 3 cm deep in a cup 3 cm wide is out of it before it meets the wall.
  EXPECT_GE(over.z() / over.head<2>().norm(), 1.0);
  variant.starts_held = true;
  EXPECT_LT((DisplacementOutOfReceptacle(variant, variant.start, inside) - straight).norm(), 1e-9);
}

TEST(SideReceptacle, AHandStaysWhereItHasLetGo) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const auto skill = SideReceptacleMake(scenes[2]);
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  state.grasped = true;
  state.touched = variant.target->object;
  TargetFrame frame(variant, state, Vector3d::UnitY(), 0.8);
  ASSERT_TRUE(frame.at_destination());
  Isometry3d& cup = state.roots[static_cast<size_t>(variant.target->object)];
  // The rim moves with a cup that rotates in the grasp, and the gripper with it.
  cup.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  cup.translation().x() += 0.02;
  frame.Update(state);
  const Vector3d held = frame.world_from_target().translation();
  state.grasped = false;
  cup.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitX()));
  frame.Update(state);
  EXPECT_EQ(frame.world_from_target().translation(), held);
  state.grasped = true;
  frame.Update(state);
  EXPECT_GT((frame.world_from_target().translation() - held).norm(), 1e-3);
}

TEST(SideReceptacle, AHandThatLeavesWaitsForItsFingers) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::OpenDoor()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  for (const bool opens : {true, false}) {
    tasks::WorldState state = variant.start;
    state.opening = 0.01;
    const Vector3d displacement(0.0, 0.0, 0.1), here = state.gripper.translation();
    TargetFrame frame(variant, state, Vector3d::UnitY(), 0.0, displacement);
    int updates = 1;
    while ((frame.world_from_target().translation() - here).norm() < 1e-9 && updates < 100) {
      if (opens && updates == 4) state.opening = 0.05;
      frame.Update(state);
      ++updates;
    }
    EXPECT_NEAR(updates, opens ? 5 : 11, 1) << opens;
    const Vector3d next = here + 0.6 * displacement;  // 6 cm ahead
    EXPECT_LT((frame.world_from_target().translation() - next).norm(), 1e-9);
  }
}

TEST(LaterWork, ATaskBeginsWhereAllOfItsWorkIsInReach) {
  const std::vector<skills::SkillSubtask> scenes = PutCupIntoMicrowave();
  ASSERT_EQ(scenes.size(), 4u);
  const std::vector<std::shared_ptr<const skills::Skill>> later = {
      SideReceptacleMake(scenes[1]), SideReceptacleMake(scenes[2]), SideReceptacleMake(scenes[3])};
  const auto opens = skills::MakeSkill(robot::Panda(true), {scenes[0]},
                                       skills::SkillOptions().ForEvaluation(), later);
  core::Rng rng = core::StreamRng(6, 0);
  int within = 0;
  for (int i = 0; i < 10; ++i) {
    const skills::StartState start = skills::SampleStart(*opens, rng);
    within += skills::IsDownstreamReachable(*opens, 0, start.state, rng);
  }
  EXPECT_GE(within, 8);
  tasks::WorldState far = opens->variants.front().start;
  const auto cup = static_cast<size_t>(later[0]->variants.front().target->object);
  far.roots[cup].translation().y() -= 3.0;
  EXPECT_FALSE(skills::IsDownstreamReachable(*opens, 0, far, rng));
  EXPECT_TRUE(skills::IsDownstreamReachable(*later[0], 0, far, rng));  // there are no later skills
  EXPECT_THROW(
      skills::MakeSkill(robot::Panda(true), {scenes[0], scenes[0]}, skills::SkillOptions(), later),
      core::Error);
}

}  // namespace
}  // namespace simwright::manipulation
