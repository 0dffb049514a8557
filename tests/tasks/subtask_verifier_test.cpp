// Every fault that a reward can have on a scene is reported under its own code, and programs in the
// styles of people and language models pass.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "tasks/language/task_answer.h"
#include "tasks/language/worked_example.h"
#include "tasks/layout.h"
#include "tasks/rules/affordances.h"
#include "tasks/verification/motion.h"
#include "tasks/verification/rank_correlation.h"
#include "tasks/verification/start_planning.h"
#include "tasks/verification/subtask_verifier.h"
#include "tasks/verification/title_direction.h"
#include "tasks/world_signals.h"
#include "tests/tasks/household.h"

namespace simwright::tasks {
namespace {

struct Case {
  const char* name;
  const char* title;
  const char* body;  // the body of compute_reward(env)
  const char* code;  // the code of the first finding; empty: none
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.name;
}

const WorldModel& SubtaskVerifierKitchen() {
  static const auto* model = new WorldModel(
      MakeWorldModel({Microwave(), DrawerUnit(), Cup(), Box("tin", {0.06, 0.06, 0.08}, 0.3)}));
  return *model;
}

core::Findings Verify(const std::string& title, const std::string& body) {
  Task task;
  task.name = title;
  Subtask subtask;
  subtask.name = title;
  subtask.program = "def compute_reward(env):\n" + body;
  SubtaskVerifier verifier(SubtaskVerifierKitchen());
  return verifier.Verify(task, &subtask);
}

#define DOOR                                                                \
  "    handle = env.get_pose_by_link_name('microwave', 'handle')\n"         \
  "    reach = torch.norm(env.get_robot_gripper_pose() - handle, dim=-1)\n" \
  "    q = env.get_state_by_joint_name('microwave', 'door_joint')\n"        \
  "    limits = env.get_limits_by_joint_name('microwave', 'door_joint')\n"
#define CUP                             \
  "    cup = env.get_position('cup')\n" \
  "    reach = torch.norm(env.get_robot_gripper_pose() - cup, dim=-1)\n"

const Case kCases[] = {
    // Valid programs.
    {"DoorByDifference", "Open the microwave",
     DOOR "    return -reach - torch.abs(limits['upper'] - q), q >= 0.9 * limits['upper']\n", ""},
    {"DoorClosing", "Close the microwave door",
     DOOR "    return -reach - torch.abs(q - limits['lower']), q <= 0.1\n", ""},
    {"DoorHalfway", "Open the door halfway",
     DOOR "    half = 0.5 * limits['upper']\n"
          "    return -reach - torch.abs(q - half), torch.abs(q - half) < 0.1\n",
     ""},
    {"DoorWithoutTitle", "microwave_1", DOOR "    return -reach - q, q <= 0.05\n",
     "success-at-start"},
    {"CupLifted", "Lift the cup", CUP "    return cup[:, 2] - reach, cup[:, 2] > 0.2\n", ""},
    {"CupStaged", "Lift the cup",
     CUP "    grasped = env.check_grasped('cup')\n"
         "    reward = torch.where(grasped, 1.0 + 5.0 * cup[:, 2], -reach)\n"
         "    return reward, grasped & (cup[:, 2] > 0.15)\n",
     ""},
    {"CupToGoal", "Bring the cup to the goal",
     CUP "    d = torch.norm(env.get_goal_pose() - cup, dim=-1)\n"
         "    return torch.exp(-5 * reach) + torch.exp(-5 * d), d < 0.05\n",
     ""},
    {"CupIntoMicrowave", "Put the cup into the microwave",
     CUP "    low, high = env.get_bounding_box_link('microwave', 'body')\n"
         "    d = torch.norm(0.5 * (low + high) - cup, dim=-1)\n"
         "    return -reach - d, env.in_bbox(cup, low, high)\n",
     ""},
    {"CupOutOfMicrowave", "Take the cup out of the microwave",
     CUP "    low, high = env.get_bounding_box_link('microwave', 'body')\n"
         "    d = torch.norm(0.5 * (low + high) - cup, dim=-1)\n"
         "    return d - reach, d > 0.4\n",
     ""},
    {"TinOnMicrowave", "Stand the tin on the microwave",
     "    tin = env.get_position('tin')\n"
     "    low, high = env.get_bounding_box_link('microwave', 'body')\n"
     "    top = 0.5 * (low + high)\n"
     "    top[:, 2] = high[:, 2] + 0.04\n"
     "    d = torch.norm(top - tin, dim=-1)\n"
     "    return -d, d < 0.03\n",
     ""},
    {"CupClosedIn", "Put the cup into the open drawer",
     CUP "    q = env.get_state_by_joint_name('drawer_unit', 'drawer_joint')\n"
         "    low, high = env.get_bounding_box_link('drawer_unit', 'drawer')\n"
         "    inside = env.in_bbox(cup, low, high)\n"
         "    d = torch.norm(0.5 * (low + high) - cup, dim=-1)\n"
         "    return q - d, torch.logical_and(inside, q > 0.1)\n",
     ""},
    // Faulty programs.
    {"AgainstSuccess", "Open the microwave",
     DOOR "    return -reach - q, q >= 0.9 * limits['upper']\n", "sign-against-success"},
    {"AwayFromHandle", "Open the microwave",
     DOOR "    return reach + q, q >= 0.9 * limits['upper']\n", "sign-against-success"},
    // The approach is rewarded; the joint's motion is not, which is not a sign fault.
    {"BlindReward", "Open the microwave", DOOR "    return -reach, q >= 0.9 * limits['upper']\n",
     ""},
    {"ClosingUnderOpening", "Open the microwave", DOOR "    return -reach - q, q <= 0.05\n",
     "title-direction"},
    {"OpeningUnderClosing", "Close the microwave", DOOR "    return q - reach, q >= 1.5\n",
     "title-direction"},
    {"BeyondLimits", "Open the microwave", DOOR "    return q - reach, q >= 2.0\n",
     "success-outside-limits"},
    {"TooHigh", "Lift the cup", CUP "    return cup[:, 2] - reach, cup[:, 2] > 2.5\n",
     "success-out-of-reach"},
    {"Never", "Lift the cup", CUP "    return cup[:, 2] - reach, cup[:, 2] > 50\n",
     "success-never"},
    {"Always", "Lift the cup", CUP "    return cup[:, 2] - reach, cup[:, 2] > -50\n",
     "constant-success"},
    {"NoSuccess", "Lift the cup", CUP "    return cup[:, 2] - reach\n", "no-success"},
    {"Constant", "Lift the cup", CUP "    return 0.0 * reach, cup[:, 2] > 0.2\n",
     "constant-reward"},
    {"NotFinite", "Lift the cup",
     CUP "    return 1.0 / torch.clamp(cup[:, 2] - 0.1, min=0.0) - reach, cup[:, 2] > 0.2\n",
     "reward-not-finite"},
    {"Itself", "Lift the cup",
     CUP "    return torch.norm(cup - cup, dim=-1) - reach, cup[:, 2] > 0.2\n", "self-distance"},
    {"UnknownLink", "Open the microwave",
     "    h = env.get_pose_by_link_name('microwave', 'handel')\n    return h[:, 0], h[:, 0] > 1\n",
     "unknown-link"},
};

class Verification : public testing::TestWithParam<Case> {};

TEST_P(Verification, FindsWhatIsWrongAndNothingElse) {
  const Case& one = GetParam();
  const core::Findings findings = Verify(one.title, one.body);
  const std::string code = findings.empty() ? "" : findings[0].code;
  EXPECT_EQ(code, one.code) << (findings.empty() ? "" : findings[0].sentence);
}

INSTANTIATE_TEST_SUITE_P(Programs, Verification, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SubtaskVerifier, ASubtaskStartsWhereTheOneBeforeEnded) {
  Task task;
  task.name = "put_away";
  task.subtasks.resize(2);
  Subtask& open = task.subtasks[0];
  open.name = "open_door";
  open.program = "def compute_reward(env):\n" DOOR "    return q - reach, q >= 1.0\n";
  Subtask& close = task.subtasks[1];
  close.name = "close_door";
  close.program = "def compute_reward(env):\n" DOOR "    return -q - reach, q <= 0.1\n";
  SubtaskVerifier verifier(SubtaskVerifierKitchen());
  EXPECT_TRUE(verifier.Verify(task, &open).empty());
  EXPECT_TRUE(verifier.Verify(task, &close).empty());
  ASSERT_EQ(close.start.joints.size(), 1u);
  EXPECT_EQ(close.start.joints[0].joint, "door_joint");
  EXPECT_GE(close.start.joints[0].position, 1.0);  // open, and no further than the next step
  EXPECT_LT(close.start.joints[0].position, 1.1);
}

TEST(SubtaskVerifier, FillsInAGoalWhereTheProgramAsksForOne) {
  Task task;
  Subtask subtask;
  subtask.name = "bring the cup";
  subtask.program = "def compute_reward(env):\n" CUP
                    "    d = torch.norm(env.get_goal_pose() - cup, dim=-1)\n"
                    "    success = d < 0.05\n"
                    "    return -d - reach, success\n";
  SubtaskVerifier verifier(SubtaskVerifierKitchen());
  EXPECT_TRUE(verifier.Verify(task, &subtask).empty());
  ASSERT_TRUE(subtask.goal.has_value());
  EXPECT_TRUE(IsPointReachable(subtask.start.world_from_robot, *subtask.goal));
  EXPECT_EQ(subtask.success, "d < 0.05");
}

TEST(RankCorrelation, IsSpearmans) {
  // Published example: IQ and hours of television, rho = -29/165.
  const std::vector<double> iq = {106, 100, 86, 101, 99, 103, 97, 113, 112, 110};
  const std::vector<double> hours = {7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
  EXPECT_NEAR(RankCorrelation(iq, hours), -29.0 / 165.0, 1e-12);
  const std::vector<double> up = {1, 2, 3}, down = {3, 2, 1}, flat = {4, 4, 4}, tied = {1, 1, 2};
  EXPECT_DOUBLE_EQ(RankCorrelation(up, up), 1.0);
  EXPECT_DOUBLE_EQ(RankCorrelation(up, down), -1.0);
  EXPECT_DOUBLE_EQ(RankCorrelation(up, flat), 0.0);
  EXPECT_NEAR(RankCorrelation(up, tied), std::sqrt(0.75), 1e-12);  // 1.5 / sqrt(2 * 1.5)
}

TEST(TitleDirection, IsTheFirstVerbs) {
  EXPECT_EQ(DirectionOfTitle("Open the microwave door"), TitleDirection::kAway);
  EXPECT_EQ(DirectionOfTitle("CloseDoor"), TitleDirection::kBack);
  EXPECT_EQ(DirectionOfTitle("close_the_open_drawer"), TitleDirection::kBack);
  EXPECT_EQ(DirectionOfTitle("Turn the faucet on"), TitleDirection::kAway);
  EXPECT_EQ(DirectionOfTitle("turn off the stove"), TitleDirection::kBack);
  EXPECT_EQ(DirectionOfTitle("Pull the drawer out"), TitleDirection::kAway);
  EXPECT_EQ(DirectionOfTitle("Slide open the window"), TitleDirection::kAway);
  EXPECT_EQ(DirectionOfTitle("slide_closed_window_2_window"), TitleDirection::kBack);
  EXPECT_EQ(DirectionOfTitle("Put the cup in the open drawer"), TitleDirection::kNone);
  EXPECT_EQ(DirectionOfTitle("Push the cup in the box"), TitleDirection::kNone);
  EXPECT_EQ(DirectionOfTitle("Put the cup on the closed box"), TitleDirection::kNone);
}

// The handle of a door that is open by q lies on a circle around its hinge.
TEST(WorldSignals, FollowTheJoints) {
  const WorldModel& model = SubtaskVerifierKitchen();
  InitialState start;
  start.placements = {{"microwave", Eigen::Isometry3d(Eigen::Translation3d(0.7, 0.1, 0.0)), true}};
  start.joints = {{"microwave", "door_joint", 1.2}};
  const WorldState state = StateOf(model, start);
  const Eigen::Vector2d hinge(0.7 - 0.2, 0.1 + 0.25);
  const Eigen::Vector3d closed(-0.06, -0.45, 0.15);
  const double x = hinge.x() + std::cos(1.2) * closed.x() + std::sin(1.2) * closed.y();
  const double y = hinge.y() - std::sin(1.2) * closed.x() + std::cos(1.2) * closed.y();
  std::vector<reward::RewardSlot> slots(3);
  slots[0] = {reward::RewardInput::kLinkPosition, "microwave", "handle", 3, "[N, 3]", false};
  slots[1] = {reward::RewardInput::kJointState, "microwave", "door_joint", 1, "[N]", false};
  slots[2] = {reward::RewardInput::kJointVelocity, "microwave", "door_joint", 1, "[N]", false};
  std::vector<std::vector<float>> values;
  WorldState before = state;
  before.joints[0][1] = 1.1;
  ASSERT_EQ(model.objects[0].joints[1].name, "door_joint");
  SlotValues(model, state, &before, 0.5, slots, &values);
  EXPECT_NEAR(values[0][0], x, 1e-6);
  EXPECT_NEAR(values[0][1], y, 1e-6);
  EXPECT_NEAR(values[0][2], 0.15, 1e-6);
  EXPECT_NEAR(values[1][0], 1.2, 1e-6);
  EXPECT_NEAR(values[2][0], 0.2, 1e-6);
  slots[0].part = "lid";
  EXPECT_THROW(SlotValues(model, state, nullptr, 0.5, slots, &values), core::Error);
}

// A second door that follows the first one by half its angle in the opposite direction.
TEST(WorldSignals, AMimicJointFollowsItsLeader) {
  assets::SemanticModel model = Microwave();
  assets::UrdfLink twin = MakeLink("twin", 1.0);
  twin.collisions = {Block({0.02, 0.4, 0.2}, {0.0, -0.2, 0.0})};
  model.model.links.push_back(twin);
  model.model.joints.push_back(MakeJoint("twin_joint", "body", "twin", assets::JointType::kRevolute,
                                         {0.3, 0, 0.1}, {0, 0, 1}, -2.0, 2.0));
  model.model.joints.back().mimic = assets::JointMimic{"door_joint", -0.5, 0.1};
  const ArticulatedObject object = MakeArticulatedObject("microwave", model);
  std::vector<double> positions = RestPositions(object);
  positions[static_cast<std::size_t>(object.FindJoint("door_joint"))] = 1.2;
  const Eigen::Isometry3d pose =
      LinkPosesOf(object, positions)[static_cast<std::size_t>(object.FindLink("twin"))];
  const Eigen::AngleAxisd expected(-0.5 * 1.2 + 0.1, Eigen::Vector3d::UnitZ());
  EXPECT_LT((pose.linear() - expected.toRotationMatrix()).norm(), 1e-12);
  EXPECT_EQ(
      GetJointUse(object, object.joints[static_cast<std::size_t>(object.FindJoint("twin_joint"))]),
      JointUse::kNone);
}

// A cup in a drawer moves with it.
TEST(Motion, WhatIsInADrawerMovesWithIt) {
  const WorldModel& model = SubtaskVerifierKitchen();
  const int chest = model.Find("drawer_unit"), cup = model.Find("cup");
  LayoutRequest request;
  request.objects = {chest, cup};
  request.supports = {{cup, chest, 0}};
  request.operated = {{chest, 0}};
  core::Rng rng(1);
  const std::optional<InitialState> start = PlanLayout(model, request, rng);
  ASSERT_TRUE(start.has_value());
  const WorldState first = StateOf(model, *start);
  const Motion motion =
      MakeMotion(model, first, {{ActionKind::kMoveJoint, chest, 0, 0.2, Eigen::Vector3d::Zero()}});
  const Eigen::Vector3d moved =
      LinkPosition(model, motion.states.back(), cup, 0) - LinkPosition(model, first, cup, 0);
  EXPECT_NEAR(moved.norm(), 0.2, 1e-9);
  EXPECT_NEAR(moved.z(), 0.0, 1e-9);
}

TEST(Layout, WhatRestsInAMicrowaveStandsInItsFront) {
  const WorldModel& model = SubtaskVerifierKitchen();
  const int microwave = model.Find("microwave"), cup = model.Find("cup");
  LayoutRequest request;
  request.objects = {microwave, cup};
  request.supports = {{cup, microwave, 0}};
  core::Rng rng(1);
  const std::optional<InitialState> start = PlanLayout(model, request, rng);
  ASSERT_TRUE(start.has_value());
  const WorldState state = StateOf(model, *start);
  // The body is 0.4 deep around its centre and opens to -x (household.h), in the frame of its
  // placement.
  const Eigen::Isometry3d& pose = state.roots[static_cast<size_t>(microwave)];
  const Eigen::Vector3d at = pose.inverse() * LinkPosition(model, state, cup, 0);
  const double half =
      0.5 * model.objects[static_cast<size_t>(cup)].box.sizes().head<2>().maxCoeff();
  EXPECT_NEAR(at.x() - half, -0.2 + 0.03, 0.4 / 40);
  EXPECT_NEAR(at.y(), 0.0, 0.4 / 40);
  EXPECT_NEAR(WorldAabb(model, state, cup).min().z(), pose.translation().z() + 0.02, 0.4 / 40);
}

// Nothing overlaps and everything is within reach.
TEST(PlanLayout, KeepsThingsApart) {
  const WorldModel& model = SubtaskVerifierKitchen();
  LayoutRequest request;
  request.objects = {0, 1, 2, 3};
  request.operated = {{0, 1}, {1, 0}};
  core::Rng rng(4);
  const std::optional<InitialState> start = PlanLayout(model, request, rng);
  ASSERT_TRUE(start.has_value());
  ASSERT_EQ(start->placements.size(), 4u);
  const WorldState state = StateOf(model, *start);
  for (int a = 0; a < 4; ++a) {
    const Eigen::AlignedBox3d box = WorldAabb(model, state, a);
    EXPECT_NEAR(box.min().z(), 0.0, 1e-9);
    for (int b = a + 1; b < 4; ++b) EXPECT_FALSE(box.intersects(WorldAabb(model, state, b)));
  }
}

// The example answer of the prompt passes verification.
TEST(SubtaskVerifier, TheWorkedExampleIsSound) {
  const WorldModel model = MakeWorldModel(ExampleModels());
  SubtaskVerifier verifier(model);
  for (Task& task : ReadTaskAnswer(ExampleAnswer()).tasks) {
    task.assets = {"chest", "block"};
    for (Subtask& subtask : task.subtasks) {
      const core::Findings findings = verifier.Verify(task, &subtask);
      EXPECT_TRUE(findings.empty()) << subtask.name << ": " << findings[0].sentence;
    }
  }
}

TEST(SubtaskVerifier, RefusesOptionsThatMakeNoSense) {
  VerificationOptions options;
  options.unclear = -0.5;
  EXPECT_THROW(SubtaskVerifier(SubtaskVerifierKitchen(), options), core::Error);
}

}  // namespace
}  // namespace simwright::tasks
