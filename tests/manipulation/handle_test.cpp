// Handles of articulated assets: their frames and obstacles, and the physics of their proof.
#include "manipulation/handle.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "manipulation/grasp_file.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/parallel_gripper.h"
#include "manipulation/proved_grasp_set.h"

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;

assets::UrdfLink BoxLink(const std::string& name, const Vector3d& center, const Vector3d& size,
                         double mass) {
  assets::UrdfLink link;
  link.name = name;
  assets::UrdfShape shape;
  shape.mesh = assets::BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(center)), &shape.mesh);
  link.collisions.push_back(shape);
  const Vector3d squares = size.cwiseAbs2();
  assets::Inertial inertial;
  inertial.mass = mass;
  inertial.center_of_mass = center;
  inertial.inertia = (mass / 12.0 * (Vector3d::Constant(squares.sum()) - squares)).asDiagonal();
  link.inertial = inertial;
  link.friction = 0.4;
  return link;
}

assets::Joint BetweenLinks(const std::string& name, const std::string& parent,
                           const std::string& child, assets::JointType type, const Vector3d& at) {
  assets::Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  joint.type = type;
  joint.parent_from_joint = Eigen::Isometry3d(Eigen::Translation3d(at));
  return joint;
}

// A cabinet with a drawer that slides by 30 cm towards -x, the drawer's bar of 12 x 160 x 12
// mm, 4.4 cm in front of it, and a second drawer without a handle that follows the first.
assets::SemanticModel Cabinet(double friction) {
  assets::SemanticModel cabinet;
  cabinet.name = "cabinet";
  assets::UrdfModel& model = cabinet.model;
  model.name = "cabinet";
  model.links = {BoxLink("body", {0.1, 0, 0.4}, {0.4, 0.5, 0.8}, 20.0),
                 BoxLink("drawer", {0, 0, 0}, {0.02, 0.45, 0.2}, 2.0),
                 BoxLink("bar", {0, 0, 0}, {0.012, 0.16, 0.012}, 0.1),
                 BoxLink("lower", {0, 0, 0}, {0.02, 0.45, 0.2}, 2.0)};
  assets::Joint slide =
      BetweenLinks("slide", "body", "drawer", assets::JointType::kPrismatic, {-0.12, 0, 0.6});
  slide.axis = Vector3d(-1, 0, 0);
  slide.upper = 0.3;
  slide.friction = friction;
  assets::Joint follows =
      BetweenLinks("follows", "body", "lower", assets::JointType::kPrismatic, {-0.12, 0, 0.3});
  follows.axis = Vector3d(-1, 0, 0);
  follows.upper = 0.3;
  follows.mimic = assets::JointMimic{"slide"};
  model.joints = {
      slide, BetweenLinks("weld", "drawer", "bar", assets::JointType::kFixed, {-0.06, 0, 0.03}),
      follows};
  cabinet.semantics["bar"] = {"fixed", "handle"};
  return cabinet;
}

const ParallelGripper& Panda() {
  static const ParallelGripper gripper = ReadGripper("panda");
  return gripper;
}

GraspProofOptions FewTrials(int count, int tries) {
  GraspProofOptions options;
  options.count = count;
  options.tries_per_grasp = tries;
  options.perturbations = 2;
  options.trial.hold_time = 0.5;
  options.sampler.candidates = 600;
  return options;
}

TEST(Handles, AreInTheFrameOfTheLinkThatIsHeld) {
  const std::vector<Handle> handles = HandlesOf("cabinet", Cabinet(5.0), 0.0);
  ASSERT_EQ(handles.size(), 2u);
  EXPECT_EQ(handles[0].joint, "slide");
  EXPECT_EQ(handles[0].link, "bar");
  EXPECT_EQ(handles[0].reason, "");
  EXPECT_EQ(handles[1].reason, "it follows slide");
  const GraspObject& object = handles[0].object;
  // The bar's origin: 18 cm in front of the cabinet's, 63 cm high.
  EXPECT_TRUE(object.support_from_object.translation().isApprox(Vector3d(-0.18, 0, 0.63), 1e-12));
  EXPECT_EQ(object.obstacles.size(), 3u);  // body, drawer and the lower drawer
  EXPECT_EQ(object.friction, 0.4);
  EXPECT_EQ(HandlesOf("cabinet", Cabinet(5.0), 0.3)[0].object.friction, 0.3);
  EXPECT_EQ(HandlesOf("cabinet", Cabinet(5.0), 0.6)[0].object.friction, 0.4);
  ASSERT_TRUE(object.part);
  EXPECT_EQ(object.part->far, 0.3);
  // The body at 40 % and at 80 %: its middle was 28 cm behind the bar; the lower drawer follows.
  ASSERT_EQ(object.passed.size(), 4u);
  EXPECT_NEAR(core::Bounds(object.passed[0]).center().x(), 0.28 + 0.4 * 0.3, 1e-12);
  EXPECT_NEAR(core::Bounds(object.passed[1]).center().x(), 0.06, 1e-12);
  EXPECT_NEAR(core::Bounds(object.passed[2]).center().x(), 0.28 + 0.8 * 0.3, 1e-12);
}

TEST(Handles, GraspsAreAtTheBarAndClearTheDrawer) {
  const Handle handle = HandlesOf("cabinet", Cabinet(5.0), 0.0)[0];
  core::Rng rng(2);
  const GraspSampling sampling =
      SampleAntipodalGrasps(handle.object, Panda().model, {.candidates = 300}, rng);
  ASSERT_GE(sampling.grasps.size(), 300u);
  for (const Grasp& grasp : sampling.grasps) {
    for (const Vector3d& contact : grasp.contacts) {
      EXPECT_LE(contact.cwiseAbs().x(), 0.006 + 1e-9);
      EXPECT_LE(contact.cwiseAbs().y(), 0.08 + 1e-9);
      EXPECT_LE(contact.cwiseAbs().z(), 0.006 + 1e-9);
    }
    // The drawer's front is the plane x = 5 cm; fingertips end a few millimetres beyond the tool.
    EXPECT_LT(grasp.object_from_tool.translation().x(), 0.05);
    EXPECT_TRUE(grasp.clears_support);  // 63 cm above the floor
  }
}

// Fingers of force F pull with 2 mu F at most. Beyond it only fingers hold that close along the
// drawer's motion, one of them behind the bar: coupled fingers give way at 2 F.
TEST(Handles, AStiffDrawerIsPulledFromBehindTheBarAlone) {
  const double force = Panda().model.force;                           // 30 N
  const double limit = 2.0 * (0.4 * Panda().model.friction) * force;  // 48 N
  const Vector3d motion(-1, 0, 0);
  const auto across = [&](const Grasp& grasp) {
    return std::abs(grasp.object_from_tool.linear().col(1).dot(motion)) < 0.5;
  };
  for (const double friction : {0.2 * limit, 1.22 * limit, 2.3 * force}) {
    const Handle handle = HandlesOf("cabinet", Cabinet(friction), 0.0)[0];
    const ProvedGrasps proved = ProveGrasps(handle.object, Panda().model, FewTrials(12, 3), 5);
    EXPECT_NEAR(proved.friction, 0.8, 1e-12);
    const auto count = std::count_if(proved.grasps.begin(), proved.grasps.end(), across);
    if (friction < limit) {
      EXPECT_EQ(proved.grasps.size(), 12u);
      EXPECT_GT(count, 0);
      EXPECT_GE(proved.EngineAgreement(), 0.9);
    } else if (friction < 2.0 * force) {
      EXPECT_EQ(count, 0);
    } else {
      EXPECT_TRUE(proved.grasps.empty());
      EXPECT_NE(proved.WhyNone(Panda().model).find("none of"), std::string::npos);
    }
  }
}

TEST(Handles, MakeASetByJoint) {
  const std::vector<Handle> handles = HandlesOf("cabinet", Cabinet(5.0), 0.0);
  std::vector<ProvedGrasps> proofs(2);
  proofs[0] = ProveGrasps(handles[0].object, Panda().model, FewTrials(2, 6), 1);
  ASSERT_EQ(proofs[0].grasps.size(), 2u);
  const GraspSet set = MakeGraspSet("cabinet", "cabinet.urdf", Panda(), handles, proofs);
  EXPECT_EQ(set.mesh, "cabinet.urdf");
  EXPECT_NEAR(set.friction, 0.8, 1e-12);
  ASSERT_EQ(set.joint_proofs.size(), 2u);
  EXPECT_EQ(set.joint_proofs[0].reason, "");
  EXPECT_EQ(set.joint_proofs[1].reason, "it follows slide");
  const std::vector<Grasp> grasps = GraspsOfJoint(set, "slide");
  ASSERT_EQ(grasps.size(), 2u);
  EXPECT_EQ(grasps[0].link, "bar");
  EXPECT_TRUE(GraspsOfJoint(set, "follows").empty());
  EXPECT_EQ(set.coverage, proofs[0].coverage);
}

}  // namespace
}  // namespace simwright::manipulation
