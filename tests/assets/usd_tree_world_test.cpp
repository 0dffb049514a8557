// Worlds of robots and objects as OpenUSD. tests/usd judges exported worlds by usd-core and MuJoCo.
#include "assets/usd_tree_world.h"

#include <numbers>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/usd_text.h"

namespace simwright::assets {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// The sample chest, whose handle is a frame without mass, with a motor at its door.
struct SampleTree {
  SampleTree() {
    ArticulatedAsset asset = SampleArticulated();
    asset.links[2].inertial = {};
    asset.joints[0].upper = 1.7;
    body.name = "chest";
    body.kinematics = MakeKinematicModel(asset);
    body.links.resize(3);
    body.links[0].meets_floor = false;
    for (size_t i = 0; i < 3; ++i) {
      TreeShape shape;
      shape.name = "shape_" + std::to_string(i);
      shape.file = "meshes/" + shape.name + ".obj";
      body.links[i].collisions = {shape};
      meshes[shape.file] = &box;
    }
    body.links[2].collisions[0].capsule = TreeCapsule{{0, 0, -0.1}, {0, 0, 0.1}, 0.02};
    body.positions = {0.5, 0.0};
    body.motors = {{0, 60.0, 3.0, 7.0, 0.6}};
    body.world_from_root.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  }

  core::TriangleMesh box = BoxMesh({0.1, 0.1, 0.1});
  std::map<std::string, const core::TriangleMesh*> meshes;
  TreeBody body;
};

TEST(TreeWorldUsd, AMotorIsADriveInDegrees) {
  const SampleTree sample;
  const Joint& door = sample.body.kinematics->joints()[0];
  const std::string joint =
      PrimText(TreeWorldUsd("room", {sample.body}, sample.meshes), "door_joint");
  EXPECT_NEAR(NumberOf(joint, "drive:angular:physics:stiffness"), 60.0 * kDegree, 1e-8);
  EXPECT_NEAR(NumberOf(joint, "drive:angular:physics:damping"), (3.0 + door.damping) * kDegree,
              1e-9);
  EXPECT_NEAR(NumberOf(joint, "drive:angular:physics:targetPosition"), 0.6 / kDegree, 1e-6);
  EXPECT_NEAR(NumberOf(joint, "drive:angular:physics:maxForce"), 7.0, 1e-9);
  EXPECT_NEAR(NumberOf(joint, "state:angular:physics:position"), 0.5 / kDegree, 1e-6);
}

TEST(TreeWorldUsd, LinksStandWhereTheStartHasThem) {
  const SampleTree sample;
  const std::string text = TreeWorldUsd("room", {sample.body}, sample.meshes);
  const std::vector<Eigen::Isometry3d> poses =
      sample.body.kinematics->LinkPoses(sample.body.positions);
  const std::string door = PrimText(text, "door");
  EXPECT_TRUE(VectorOf(door, "xformOp:translate").isApprox(poses[1].translation(), 1e-12));
  EXPECT_TRUE(
      RotationOf(door, "xformOp:orient").toRotationMatrix().isApprox(poses[1].linear(), 1e-12));
  EXPECT_EQ(VectorOf(PrimText(text, "held"), "physics:localPos0"), Eigen::Vector3d(1, 2, 3));
  // The handle is no body: its capsule belongs to the door.
  const std::string handle = PrimText(door, "handle_0_frame");
  EXPECT_FALSE(handle.empty());
  EXPECT_EQ(handle.find("PhysicsRigidBodyAPI"), std::string::npos);
  EXPECT_EQ(NumberOf(handle, "double height"), 0.2);
  EXPECT_EQ(NumberOf(handle, "double radius"), 0.02);
  EXPECT_TRUE(PrimText(text, "handle_0_joint").empty());
  // Links of a body do not meet each other, and the root does not meet the floor.
  EXPECT_NE(
      PrimText(text, "body").find("filteredPairs = [</room/chest/door>, </room/ground/plane>]"),
      std::string::npos);
}

TEST(TreeWorldUsd, AMissingMeshAndEqualNamesAreRefused) {
  SampleTree sample;
  EXPECT_THROW(TreeWorldUsd("room", {sample.body, sample.body}, sample.meshes), core::Error);
  sample.meshes.erase("meshes/shape_1.obj");
  EXPECT_THROW(TreeWorldUsd("room", {sample.body}, sample.meshes), core::Error);
}

}  // namespace
}  // namespace simwright::assets
