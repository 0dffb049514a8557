// The rules find the possible actions and their combinations, and generate valid tasks.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tasks/rules/affordances.h"
#include "tasks/rules/planner.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/world_state.h"
#include "tests/tasks/household.h"

namespace simwright::tasks {
namespace {

WorldModel RuleTasksKitchen() {
  return MakeWorldModel({Microwave(), DrawerUnit(), Cup(), Cup("jug", 0.045, 0.16),
                         Box("book", {0.2, 0.15, 0.03}, 0.6), Box("tin", {0.06, 0.06, 0.08}, 0.3)});
}

TEST(Cavities, AMicrowavesRoomIsWhatItsWallsEnclose) {
  const WorldModel model = MakeWorldModel({Microwave()});
  const ArticulatedObject& object = model.objects[0];
  ASSERT_EQ(object.receptacles.size(), 1u);
  const Receptacle& room = object.receptacles[0];
  // The interior is 0.38 x 0.46 x 0.26, from the back wall to the front. A cell is 1/40 of 0.5 m.
  const double cell = 0.5 / 40;
  EXPECT_NEAR(room.box.sizes().x(), 0.38, 2 * cell);
  EXPECT_NEAR(room.box.sizes().y(), 0.46, 2 * cell);
  EXPECT_NEAR(room.box.sizes().z(), 0.26, 2 * cell);
  EXPECT_NEAR(room.box.center().y(), 0.0, cell);
  EXPECT_EQ(room.opening, -Eigen::Vector3d::UnitX());
  ASSERT_EQ(room.door, object.FindJoint("door_joint"));
}

TEST(Cavities, ACupOpensAboveAndABlockHasNone) {
  const WorldModel model = MakeWorldModel({Cup(), Box("block", {0.1, 0.1, 0.1}, 0.5)});
  ASSERT_EQ(model.objects[0].receptacles.size(), 1u);
  EXPECT_EQ(model.objects[0].receptacles[0].opening, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(model.objects[0].receptacles[0].door, -1);
  EXPECT_GT(model.objects[0].receptacles[0].box.sizes().z(), 0.08);
  EXPECT_TRUE(model.objects[1].receptacles.empty());
}

// The cabinet's interior is filled by its drawer; the drawer's receptacle is opened by pulling it
// out.
TEST(Cavities, ADrawersRoomIsOpenedByTheDrawer) {
  const WorldModel model = MakeWorldModel({DrawerUnit()});
  const ArticulatedObject& object = model.objects[0];
  ASSERT_EQ(object.receptacles.size(), 1u);
  EXPECT_EQ(object.receptacles[0].link, object.FindLink("drawer"));
  EXPECT_EQ(object.receptacles[0].door, object.FindJoint("drawer_joint"));
  EXPECT_EQ(object.receptacles[0].opening, Eigen::Vector3d::UnitZ());
}

// Two drawers, one above the other: each opens its own receptacle, although the upper one covers
// the lower one.
TEST(Cavities, DrawersAboveEachOtherAreOpenedEachByItself) {
  assets::SemanticModel chest = DrawerUnit();
  for (core::TriangleMesh* mesh :
       {&chest.model.links[1].collisions[1].mesh, &chest.model.links[1].collisions[2].mesh,
        &chest.model.links[1].collisions[3].mesh, &chest.model.links[1].collisions[4].mesh}) {
    core::Transform(
        Eigen::Affine3d(Eigen::Translation3d(0, 0, -0.06) * Eigen::Scaling(1.0, 1.0, 0.45)), mesh);
  }
  assets::UrdfLink upper = chest.model.links[1];
  upper.name = "drawer_1";
  chest.model.links.push_back(upper);
  chest.model.joints.push_back(MakeJoint("upper_joint", "body", "drawer_1",
                                         assets::JointType::kPrismatic, {-0.02, 0, 0.27},
                                         {-1, 0, 0}, 0.0, 0.25));
  const ArticulatedObject object = MakeArticulatedObject("chest", chest);
  ASSERT_EQ(object.receptacles.size(), 2u);
  for (const Receptacle& receptacle : object.receptacles) {
    EXPECT_EQ(object.joints[static_cast<std::size_t>(receptacle.door)].link, receptacle.link);
  }
}

TEST(Affordances, FollowFromLabelsAndSizes) {
  const WorldModel model = RuleTasksKitchen();
  const ArticulatedObject& microwave = model.objects[0];
  EXPECT_EQ(GetJointUse(microwave, microwave.joints[microwave.FindJoint("door_joint")]),
            JointUse::kOpen);
  EXPECT_EQ(GetJointUse(microwave, microwave.joints[microwave.FindJoint("button_joint")]),
            JointUse::kPress);
  EXPECT_TRUE(CanBeLifted(model.objects[2]));
  EXPECT_FALSE(CanBeLifted(microwave));
  EXPECT_FALSE(CanBeLifted(MakeWorldModel({Box("brick", {0.2, 0.2, 0.2}, 1.0)}).objects[0]));
  EXPECT_FALSE(CanBeLifted(MakeWorldModel({Box("lead", {0.05, 0.05, 0.05}, 6.0)}).objects[0]));
  EXPECT_TRUE(CanStandOn(model.objects[5], model.objects[4]));   // the tin on the book
  EXPECT_FALSE(CanStandOn(model.objects[4], model.objects[5]));  // not the book on the tin
  EXPECT_FALSE(CanStandOn(model.objects[5], model.objects[2]));  // a cup has no top
  EXPECT_TRUE(FitsInto(model.objects[2], microwave, 0));
  EXPECT_FALSE(FitsInto(microwave, microwave, 0));
}

TEST(Planner, OpensBeforeItFillsAndClosesAfter) {
  const WorldModel model = RuleTasksKitchen();
  const int microwave = 0, cup = 2;
  const int door = model.objects[0].FindJoint("door_joint");
  PredicateSet predicates{{PredicateKind::kGripperEmpty},
                          {PredicateKind::kJointAtRest, microwave, -1, door},
                          {PredicateKind::kOnFloor, cup},
                          {PredicateKind::kFree, cup},
                          {PredicateKind::kFree, microwave}};
  const std::vector<Operator> plan = Plan(
      OperatorsFor(model, {microwave, cup}),
      {{PredicateKind::kIn, cup, microwave, 0}, {PredicateKind::kJointAtRest, microwave, -1, door}},
      &predicates);
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_EQ(plan[0].verb, ActionType::kOpen);
  EXPECT_EQ(plan[1].verb, ActionType::kPick);
  EXPECT_EQ(plan[2].verb, ActionType::kPutInto);
  EXPECT_EQ(plan[3].verb, ActionType::kClose);
  EXPECT_TRUE(predicates.contains({PredicateKind::kIn, cup, microwave, 0}));
  EXPECT_FALSE(predicates.contains({PredicateKind::kJointAway, microwave, -1, door}));
}

TEST(RuleTasks, AreSoundAndOfEveryKind) {
  const WorldModel model = RuleTasksKitchen();
  RuleOptions options;
  options.count = 60;
  const RuleTasks result = GenerateTasksByRules(model, options);
  std::set<std::string> names;
  std::size_t longest = 0;
  for (const Task& task : result.tasks) {
    EXPECT_TRUE(task.valid()) << task.name;
    EXPECT_TRUE(names.insert(task.name).second) << task.name;
    longest = std::max(longest, task.subtasks.size());
  }
  EXPECT_GE(result.tasks.size(), 40u);
  EXPECT_GE(longest, 4u);
  for (const char* name : {"open_microwave_door", "close_microwave_door", "press_microwave_button",
                           "open_drawer_unit_drawer", "pick_up_cup", "push_book",
                           "put_cup_into_microwave_and_close_it", "take_cup_out_of_microwave",
                           "place_tin_on_book", "pour_from_jug_into_cup"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

// A door open to its limit, 97 degrees, would turn its handle away: a joint to be closed starts
// where the opening task ends, slightly beyond 70 %.
TEST(RuleTasks, ClosingBeginsWhereOpeningEnds) {
  const RuleTasks result = GenerateTasksByRules(MakeWorldModel({Microwave()}), {10, 1});
  const auto closing = std::find_if(result.tasks.begin(), result.tasks.end(), [](const Task& task) {
    return task.name == "close_microwave_door";
  });
  ASSERT_NE(closing, result.tasks.end());
  const std::vector<JointCondition>& joints = closing->subtasks.front().start.joints;
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_EQ(joints[0].joint, "door_joint");
  EXPECT_GE(joints[0].position, 0.7 * 1.7);
  EXPECT_LE(joints[0].position, 0.85 * 1.7);
}

// Names in a URDF are text: quotes and line breaks in them do not end a string or a comment.
TEST(RuleTasks, NamesWithQuotesAndLineBreaksStayNames) {
  assets::SemanticModel model = Microwave();
  model.model.joints[1].name = "door\"joint\\";
  model.model.links[3].name = "han\ndle 'x'";
  model.model.joints[2].child = model.model.links[3].name;
  model.semantics[model.model.links[3].name] = {"fixed", "handle"};
  const RuleTasks result = GenerateTasksByRules(MakeWorldModel({model}), {3, 1});
  std::set<std::string> names;
  for (const Task& task : result.tasks) names.insert(task.name);
  EXPECT_TRUE(names.contains("open_microwave_door"));
  EXPECT_TRUE(names.contains("close_microwave_door"));
  EXPECT_TRUE(result.dropped.empty());
}

// Two objects stored in one receptacle do not interpenetrate.
TEST(RuleTasks, StoredThingsStandApart) {
  const WorldModel model = RuleTasksKitchen();
  const RuleTasks result = GenerateTasksByRules(model, {60, 1});
  int stored = 0;
  for (const Task& task : result.tasks) {
    if (task.name.rfind("store_", 0) != 0) continue;
    ++stored;
    const WorldState state = StateOf(model, task.subtasks.back().start);  // before it is closed
    std::vector<int> objects;
    for (const std::string& name : task.assets) {
      if (!model.objects[static_cast<std::size_t>(model.Find(name))].articulated()) {
        objects.push_back(model.Find(name));
      }
    }
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_FALSE(
        WorldAabb(model, state, objects[0]).intersects(WorldAabb(model, state, objects[1])))
        << task.name;
  }
  EXPECT_GE(stored, 2);
}

TEST(RuleTasks, AreTheSameForASeed) {
  const WorldModel model = RuleTasksKitchen();
  const RuleTasks a = GenerateTasksByRules(model, {12, 5});
  const RuleTasks b = GenerateTasksByRules(model, {12, 5});
  ASSERT_EQ(a.tasks.size(), b.tasks.size());
  for (std::size_t i = 0; i < a.tasks.size(); ++i) {
    EXPECT_EQ(a.tasks[i].name, b.tasks[i].name);
    ASSERT_EQ(a.tasks[i].subtasks.size(), b.tasks[i].subtasks.size());
    for (std::size_t s = 0; s < a.tasks[i].subtasks.size(); ++s) {
      EXPECT_EQ(a.tasks[i].subtasks[s].program, b.tasks[i].subtasks[s].program);
    }
  }
}

}  // namespace
}  // namespace simwright::tasks
