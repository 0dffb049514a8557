// The approach of a gripper to a part: not through the floor, not through the part's support.
#include "manipulation/approach_choice.h"

#include <gtest/gtest.h>

#include "manipulation/gripper_penetration.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Returns a skill that moves joint "part_joint" of `asset`, which is fixed in front of the robot.
std::shared_ptr<const skills::Skill> Moving(const assets::SemanticModel& asset) {
  skills::SkillSubtask scene;
  scene.assets = {skills::WithInertia(asset)};
  scene.subtask.name = "move";
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    moved = env.get_state_by_joint_name(\"asset\", \"part_joint\")\n"
      "    return moved, moved >= 0.05\n";
  tasks::AssetPlacement placement;
  placement.asset = "asset";
  placement.fixed = true;
  placement.world_from_asset.translation() = Vector3d(0.5, 0.0, 0.0);
  scene.subtask.start.placements = {placement};
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

// Returns a body of blocks with one part.
assets::SemanticModel Asset(const std::vector<assets::UrdfShape>& body, const Vector3d& part_size,
                            const assets::Joint& joint,
                            const Vector3d& part_at = Vector3d::Zero()) {
  assets::SemanticModel asset;
  asset.name = "asset";
  assets::UrdfLink base = tasks::MakeLink("body", 5.0), part = tasks::MakeLink("part", 0.1);
  base.collisions = body;
  part.collisions = {tasks::Block(part_size, part_at)};
  asset.model.links = {base, part};
  asset.model.joints = {joint};
  return asset;
}

Vector3d ApproachOf(const skills::Skill& skill) {
  const skills::SkillVariant& variant = skill.variants.front();
  return GraspPoseAtJoint(variant.model, variant.start, *variant.target).linear().col(2);
}

Grasp GraspAt(const Isometry3d& tool, double quality) {
  Grasp grasp;
  grasp.object_from_tool = tool;
  grasp.quality = quality;
  return grasp;
}

TEST(WithProvedGrasps, ComeBeforeTheApproachThatTheyAreLike) {
  const Isometry3d first = Isometry3d::Identity();  // along z
  Isometry3d second = Isometry3d::Identity();       // along x
  second.linear() = Eigen::AngleAxisd(1.57, Vector3d::UnitY()).toRotationMatrix();
  const auto moved = [](const Isometry3d& tool, const Vector3d& by, double turn) {
    Isometry3d other = tool;
    other.translate(by);
    other.rotate(Eigen::AngleAxisd(turn, Vector3d::UnitX()));
    return other;
  };
  const std::vector<Grasp> grasps = {
      GraspAt(moved(second, {0.0, 0.02, 0.0}, 0.0), 0.6),
      GraspAt(moved(first, {0.01, 0.0, 0.0}, 0.2), 0.5),
      GraspAt(moved(first, {0.02, 0.0, 0.0}, 0.2), 1.0),
      GraspAt(moved(first, {0.0, 0.0, -0.01}, 0.0), 1.0),  // 1 cm shallower
      GraspAt(moved(first, {0.0, 0.0, 0.0}, 0.8), 1.0)};   // 46 degrees off both
  const std::vector<Isometry3d> all = WithProvedGrasps({first, second}, grasps);
  ASSERT_EQ(all.size(), 5u);
  const Isometry3d* expected[] = {&grasps[2].object_from_tool, &grasps[1].object_from_tool, &first,
                                  &grasps[0].object_from_tool, &second};
  for (size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(all[i].isApprox(*expected[i], 1e-12)) << i;
}

TEST(ChooseApproach, AKnobBesideATallSpoutIsTakenFromAbove) {
  // The knob stands on a deck, lower than the middle of the whole: outwards along its axis from
  // there is down, into the deck.
  const auto skill = Moving(Asset(
      {tasks::Block({0.1, 0.3, 0.04}, {0, 0, 0.02}), tasks::Block({0.04, 0.04, 0.3}, {0, 0, 0.19})},
      {0.05, 0.02, 0.03},
      tasks::MakeJoint("part_joint", "body", "part", assets::JointType::kRevolute, {0, 0.1, 0.06},
                       {0, 0, 1}, 0.0, 2.0)));
  EXPECT_LT((ApproachOf(*skill) + Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(ChooseApproach, ALeverThatGoesDownIsPressedFromTheFront) {
  // A block of 20 cm with the lever on its front: a gripper straight from above would hit its edge,
  // a level one brings the flange near the floor.
  const auto skill =
      Moving(Asset({tasks::Block({0.2, 0.3, 0.2}, {0, 0, 0.1})}, {0.03, 0.04, 0.012},
                   tasks::MakeJoint("part_joint", "body", "part", assets::JointType::kPrismatic,
                                    {-0.115, 0, 0.16}, {0, 0, -1}, 0.0, 0.09)));
  EXPECT_LT((ApproachOf(*skill) - Vector3d(1.0, 0.0, -2.0).normalized()).norm(), 1e-9);
}

TEST(ChooseApproach, AHandThatTakesALidDoesNotEndPointingBackAtTheRobot) {
  // The hinge is at the back; the handle, on the lid's front, moves up and over. From above is
  // along its motion and collision-free, but the gripper turns with the lid.
  const auto skill =
      Moving(Asset({tasks::Block({0.3, 0.3, 0.2}, {0, 0, 0.1})}, {0.03, 0.1, 0.03},
                   tasks::MakeJoint("part_joint", "body", "part", assets::JointType::kRevolute,
                                    {0.15, 0, 0.2}, {0, 1, 0}, 0.0, 1.5),
                   {-0.27, 0, 0.02}));
  const skills::SkillVariant& variant = skill->variants.front();
  EXPECT_LT(variant.target->approaches.front().linear()(2, 2), -0.9);
  const Vector3d at_first = ApproachOf(*skill);
  const Vector3d opened = Eigen::AngleAxisd(1.2, Vector3d::UnitY()) * at_first;
  EXPECT_GT(at_first.x(), 0.3);
  EXPECT_GT(opened.x(), -0.75);
  EXPECT_LT(opened.z(), 0.0);
}

TEST(ChooseApproach, WhereAllIsFreeTheHandComesAlongThePartsWay) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::OpenDoor()},
                                       skills::SkillOptions().ForEvaluation());
  const InteractionTarget& target = *skill->variants.front().target;
  EXPECT_EQ(target.link_from_grasp.matrix(), target.approaches.front().matrix());
}

TEST(GripperSurface, OfThePandaIsItsHandAndOpenFingers) {
  const std::vector<Vector3d> points = GripperSurface(robot::Panda(false), 0.01).points;
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  // The Franka hand is 20 cm wide from finger to finger and 6 to 7 cm thick, its flange 10.3 cm
  // behind the fingertips' middle; the tips extend a centimetre beyond that.
  EXPECT_NEAR(box.sizes().y(), 0.2, 0.03);
  EXPECT_NEAR(box.sizes().x(), 0.065, 0.03);
  EXPECT_NEAR(box.max().z(), 0.01, 0.006);
  EXPECT_LT(box.min().z(), -0.1);
  // Nothing is between the open fingers.
  for (const Vector3d& point : points) {
    EXPECT_FALSE(std::abs(point.y()) < 0.038 && point.z() > -0.02) << point.transpose();
  }
}

TEST(PenetrationDepth, IsTheDistanceToTheNearestFace) {
  assets::SemanticModel asset =
      Asset({tasks::Block({0.2, 0.2, 0.2}, {0, 0, 0.1})}, {0.02, 0.02, 0.02},
            tasks::MakeJoint("part_joint", "body", "part", assets::JointType::kPrismatic,
                             {-0.11, 0, 0.1}, {-1, 0, 0}, 0.0, 0.1));
  const BodyParts body = ConvexPartsOf(sim::ArticulatedBodyFrom(skills::WithInertia(asset).model));
  std::vector<Isometry3d> links(2, Isometry3d::Identity());
  links[1].translation() = Vector3d(-0.11, 0.0, 0.1);
  const SurfacePoints point({Vector3d(0.0, 0.0, 0.01)});
  const auto at = [&](double x, double z, int gripped) {
    Isometry3d tool = Isometry3d::Identity();
    tool.translation() = Vector3d(x, 0.0, z);
    return PenetrationDepth(point, tool, body, links, gripped);
  };
  EXPECT_NEAR(at(-0.07, 0.1, 1), 0.03, 1e-12);   // in the body, 3 cm behind its front
  EXPECT_NEAR(at(0.0, 0.17, 1), 0.02, 1e-12);    // 2 cm below its top
  EXPECT_NEAR(at(-0.11, 0.09, 0), 0.01, 1e-12);  // in the part
  EXPECT_EQ(at(-0.11, 0.09, 1), 0.0);            // which is ignored once it is gripped
  EXPECT_EQ(at(-0.3, 0.1, 1), 0.0);
  EXPECT_NEAR(at(-0.3, -0.05, 1), 0.04, 1e-12);  // in the floor
}

// The bounding sphere never changes the result over the points of a surface, checked against the
// planes of an octahedron's eight faces.
TEST(PenetrationIntoPart, IsThatOfThePointsOneByOne) {
  core::TriangleMesh octahedron;
  for (const double side : {0.1, -0.1}) {
    for (int axis = 0; axis < 3; ++axis) octahedron.vertices.push_back(side * Vector3d::Unit(axis));
  }
  octahedron.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                          {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  const ConvexPart solid(octahedron);
  EXPECT_EQ(solid.faces.size(), 8u);
  core::Rng rng = core::StreamRng(6, 0);
  const auto random = [&](double range) {
    return Vector3d(core::Uniform(rng, -range, range), core::Uniform(rng, -range, range),
                    core::Uniform(rng, -range, range));
  };
  std::vector<Vector3d> points;
  for (int i = 0; i < 30; ++i) points.push_back(Vector3d(0.3, 0.0, 0.0) + random(0.08));
  const SurfacePoints surface(points);
  int touching = 0, clear = 0;
  for (int i = 0; i < 300; ++i) {
    Isometry3d pose = Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(core::Uniform(rng, 0.0, 3.0), random(1.0).normalized()));
    pose.translation() = pose.linear() * Vector3d(-0.3, 0.0, 0.0) + random(0.2);
    double deepest = 0.0;
    for (const Vector3d& point : points) {
      const double inside = 0.1 - (pose * point).lpNorm<1>();  // times sqrt(3) from the face
      deepest = std::max(deepest, inside / std::sqrt(3.0));
    }
    EXPECT_NEAR(PenetrationIntoPart(solid, surface, pose), deepest, 1e-12);
    ++(deepest > 0.0 ? touching : clear);
  }
  EXPECT_GT(touching, 20);
  EXPECT_GT(clear, 20);
}

}  // namespace
}  // namespace simwright::manipulation
