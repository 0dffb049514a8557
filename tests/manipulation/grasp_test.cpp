// Grasps: closed forms of sampling, diversity and the gripper's geometry, proofs in both engines,
// and the file of grasps.
#include "manipulation/grasp_proof.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "geometry/distance.h"
#include "geometry/mass_properties.h"
#include "manipulation/grasp_file.h"
#include "manipulation/parallel_gripper.h"
#include "manipulation/proved_grasp_set.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

GraspObject ObjectOf(core::TriangleMesh mesh, double mass, double friction = 0.4) {
  GraspObject object;
  object.name = "object";
  const auto unit = geometry::SolidMassProperties(mesh, 1.0);
  const auto solid = geometry::SolidMassProperties(mesh, mass / unit.mass);
  object.body.name = "object";
  object.body.parts = {mesh};
  object.body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  object.surface = std::move(mesh);
  object.friction = friction;
  return object;
}

const ParallelGripper& PandaGripper() {
  static const ParallelGripper gripper = ReadGripper("panda");
  return gripper;
}

// Returns the message of the core::Error that `make` throws.
template <typename Make>
std::string ErrorOf(const Make& make) {
  try {
    make();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParallelGripper, ReadsThePanda) {
  const ParallelGripper& gripper = PandaGripper();
  EXPECT_NEAR(gripper.model.max_opening, 0.08, 1e-4);  // two strokes of 4 cm
  EXPECT_EQ(gripper.model.force, 30.0);
  EXPECT_EQ(gripper.model.friction, 2.0);
  EXPECT_EQ(gripper.base_link, "panda_hand");
  EXPECT_NEAR(gripper.tool_from_base.translation().z(), -0.1034, 1e-9);
  ASSERT_EQ(gripper.joints.size(), 2u);
  EXPECT_NEAR(gripper.JointPosition(0, gripper.model.max_opening), 0.04, 1e-9);
  EXPECT_NEAR(gripper.JointPosition(1, 0.0), 0.0, 1e-4);
}

// A gripper alone, whose fingers slide along x and whose tool frame the URDF does not have.
std::string GripperText(const std::string& second_axis, const std::string& type = "prismatic") {
  const auto finger = [&](const std::string& name, const std::string& x, const std::string& axis) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"0.02\"/><inertia ixx=\"1e-5\" iyy=\"1e-5\" izz=\"1e-5\" "
           "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><box size=\"0.01 0.02 "
           "0.05\"/></geometry></collision></link><joint name=\"" +
           name + "_joint\" type=\"" + type + "\"><parent link=\"base\"/><child link=\"" + name +
           "\"/><origin xyz=\"" + x + " 0 0.08\"/><axis xyz=\"" + axis +
           "\"/><limit lower=\"0\" upper=\"0.03\" effort=\"15\" velocity=\"0.1\"/></joint>";
  };
  return "<robot name=\"slider\"><link name=\"base\"><inertial><mass value=\"0.5\"/><inertia "
         "ixx=\"1e-3\" iyy=\"1e-3\" izz=\"1e-3\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
         "<collision><geometry><box size=\"0.12 0.05 0.06\"/></geometry></collision></link>" +
         finger("left", "0.005", "1 0 0") + finger("right", "-0.005", second_axis) + "</robot>";
}

TEST(ParallelGripper, ReadsAUrdfOfAGripperAlone) {
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "slider.urdf";
  core::WriteFile(file, GripperText("-1 0 0"));
  const ParallelGripper gripper = ReadGripper(file.string());
  EXPECT_NEAR(gripper.model.max_opening, 0.06, 1e-9);  // 2 x 3 cm, closed without a gap
  EXPECT_EQ(gripper.model.force, 15.0);
  EXPECT_EQ(gripper.base_link, "base");
  // 1 cm behind the tips at 8 cm + 2.5 cm, approaching along the base's z.
  const Isometry3d base_from_tool = gripper.tool_from_base.inverse();
  EXPECT_NEAR(base_from_tool.translation().z(), 0.095, 1e-9);
  EXPECT_NEAR(base_from_tool.linear().col(2).z(), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(base_from_tool.linear().col(1).x()), 1.0, 1e-9);
  ASSERT_EQ(gripper.findings.size(), 1u);
  EXPECT_EQ(gripper.findings[0].code, "gripper-tool-guessed");
}

TEST(ParallelGripper, SaysWhatIsNoParallelGripper) {
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "slider.urdf";
  core::WriteFile(file, GripperText("0 1 0"));
  EXPECT_NE(ErrorOf([&] { ReadGripper(file.string()); }).find("do not slide along one line"),
            std::string::npos);
  core::WriteFile(file, GripperText("-1 0 0", "revolute"));
  EXPECT_NE(ErrorOf([&] { ReadGripper(file.string()); }).find("is not prismatic"),
            std::string::npos);
  EXPECT_NE(ErrorOf([&] { ReadGripper("robotiq"); }).find("no such gripper"), std::string::npos);
}

// The contacts of each grasp are computed again by a brute-force line through all triangles.
TEST(GraspSampler, GraspsAreAntipodalAndCollisionFree) {
  const GraspObject object = ObjectOf(assets::CylinderMesh(0.03, 0.12, 48), 0.3);
  core::Rng rng(3);
  const GraspSamplerOptions options{.candidates = 400};
  const GraspSampling sampling = SampleAntipodalGrasps(object, PandaGripper().model, options, rng);
  ASSERT_GE(sampling.grasps.size(), 400u);
  for (const Grasp& grasp : sampling.grasps) {
    const Vector3d axis = (grasp.contacts[1] - grasp.contacts[0]).normalized();
    EXPECT_NEAR((grasp.contacts[1] - grasp.contacts[0]).norm(), grasp.width, 1e-9);
    EXPECT_LE(grasp.width, 0.06 / std::cos(options.largest_angle) + 1e-9);
    EXPECT_GT(axis.dot(grasp.object_from_tool.linear().col(1)), 1.0 - 1e-9);
    for (const double side : {-1.0, 1.0}) {
      const size_t c = side < 0.0 ? 0 : 1;
      // The outward normal of the cylinder or a cap, from the point alone.
      const Vector3d& point = grasp.contacts[c];
      const bool cap = std::abs(std::abs(point.z()) - 0.06) < 1e-6;
      const Vector3d outward = cap ? Vector3d(0, 0, point.z()).normalized()
                                   : Vector3d(point.x(), point.y(), 0.0).normalized();
      // 48 facets turn the normal by up to 3.75 degrees.
      EXPECT_LE(std::acos(std::min(1.0, side * outward.dot(axis))), options.largest_angle + 0.066);
    }
    for (const double back : {0.0, 0.03, 0.1}) {
      Isometry3d tool = grasp.object_from_tool;
      tool.translation() -= back * grasp.Approach();
      for (const core::TriangleMesh& part : PandaGripper().model.palm) {
        core::TriangleMesh moved = part;
        core::Transform(Eigen::Affine3d(tool), &moved);
        EXPECT_GT(geometry::SignedDistance({moved.vertices}, {object.surface.vertices}).distance,
                  0.0);
      }
    }
  }
}

TEST(GraspSampler, FindsTheTwoWallsOfAHollowBox) {
  // Four boards of 4 mm around an opening of 60 mm: only the boards' thickness is graspable for a
  // gripper that opens by 30 mm.
  GraspObject object = ObjectOf(assets::BoxMesh({0.004, 0.068, 0.08}), 0.1);
  for (const double x : {-0.032, 0.032}) {
    core::TriangleMesh board = assets::BoxMesh({0.004, 0.068, 0.08});
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)), &board);
    if (x < 0.0) {
      object.surface = board;
      object.body.parts = {board};
    } else {
      core::Append(board, &object.surface);
      object.body.parts.push_back(board);
    }
  }
  sim::GripperModel gripper = PandaGripper().model;
  core::Rng rng(1);
  const GraspSampling sampling = SampleAntipodalGrasps(object, gripper, {.candidates = 200}, rng);
  ASSERT_FALSE(sampling.grasps.empty());
  int thin = 0, wide = 0;
  for (const Grasp& grasp : sampling.grasps) {
    if (grasp.width < 0.005) ++thin;
    if (grasp.width > 0.06) ++wide;
  }
  EXPECT_GT(thin, 0);  // a finger between the boards
  EXPECT_GT(wide, 0);  // both boards
}

TEST(Grasps, AnglesOfAGripperAreSymmetric) {
  const Isometry3d one = Isometry3d::Identity();
  const Isometry3d half(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()));
  const Isometry3d tilted(Eigen::AngleAxisd(0.4, Vector3d::UnitX()));
  EXPECT_NEAR(GraspAngle(one, half), 0.0, 1e-7);
  EXPECT_NEAR(GraspAngle(one, tilted), 0.4, 1e-7);
  EXPECT_NEAR(GraspAngle(one, tilted * half), 0.4, 1e-7);
  EXPECT_NEAR(
      GraspAngle(one, Isometry3d(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ()))),
      0.5 * std::numbers::pi, 1e-7);
}

TEST(Grasps, FarthestPointSamplingSpreads) {
  std::vector<Grasp> grasps(101);
  for (size_t i = 0; i < grasps.size(); ++i) {
    for (Vector3d& contact : grasps[i].contacts) contact.x() = 0.0099 * static_cast<double>(i);
  }
  EXPECT_EQ(FarthestGrasps(grasps, 3), (std::vector<int>{0, 100, 50}));
  EXPECT_EQ(FarthestGrasps(grasps, 500).size(), grasps.size());
  // Every grasp within 2 cm: 3 at each end, 5 in the middle.
  EXPECT_NEAR(GraspCoverage(grasps, {grasps[0], grasps[50], grasps[100]}), 11.0 / 101.0, 1e-12);
}

TEST(GraspProof, ProvesGraspsOfABoxInBothEngines) {
  const GraspObject object = ObjectOf(assets::BoxMesh({0.05, 0.04, 0.08}), 0.25);
  GraspProofOptions options;
  options.count = 6;
  options.perturbations = 4;
  const ProvedGrasps proved = ProveGrasps(object, PandaGripper().model, options, 7);
  ASSERT_EQ(proved.grasps.size(), 6u);
  EXPECT_NEAR(proved.friction, 0.8, 1e-12);
  EXPECT_GE(proved.EngineAgreement(), 0.9);
  EXPECT_GT(proved.coverage, 0.1);
  for (size_t i = 0; i < proved.grasps.size(); ++i) {
    EXPECT_GE(proved.grasps[i].quality, options.least_quality);
    if (i > 0) {
      EXPECT_LE(proved.grasps[i].quality, proved.grasps[i - 1].quality);
    }
  }
  // The same for any number of threads.
  core::SetThreadCount(1);
  const ProvedGrasps again = ProveGrasps(object, PandaGripper().model, options, 7);
  core::SetThreadCount(0);
  ASSERT_EQ(again.grasps.size(), proved.grasps.size());
  for (size_t i = 0; i < proved.grasps.size(); ++i) {
    EXPECT_EQ(again.grasps[i].object_from_tool.matrix(),
              proved.grasps[i].object_from_tool.matrix());
    EXPECT_EQ(again.grasps[i].quality, proved.grasps[i].quality);
  }
}

TEST(GraspProof, SaysWhyAnObjectCannotBeGrasped) {
  const auto reason = [](const GraspObject& object) {
    return ErrorOf([&] { ProveGrasps(object, PandaGripper().model, {}, 1); });
  };
  EXPECT_NE(reason(ObjectOf(assets::BoxMesh({0.1, 0.12, 0.15}), 0.5))
                .find("wider than the hand: its narrowest place is 100.0 mm"),
            std::string::npos);
  EXPECT_NE(reason(ObjectOf(assets::BoxMesh({0.1, 0.12, 0.002}), 0.05)).find("it is 2.0 mm thin"),
            std::string::npos);
  // 2 x 0.8 x 30 N hold 48 N: 5 kg weigh 49.05 N.
  EXPECT_NE(reason(ObjectOf(assets::BoxMesh({0.05, 0.05, 0.05}), 5.0)).find("too heavy: 5.00 kg"),
            std::string::npos);
}

TEST(GraspFile, ReadsWhatItWrote) {
  ProvedGrasps proved;
  proved.friction = 0.8;
  proved.tried = 9;
  proved.held_in_bullet = 5;
  proved.held_in_both = 4;
  proved.coverage = 0.375;
  Grasp grasp;
  grasp.object_from_tool = Eigen::Translation3d(0.1, -0.2, 0.3) *
                           Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, 3.0).normalized());
  grasp.width = 0.04;
  grasp.opening = 0.06;
  grasp.quality = 0.875;
  grasp.contacts = {Vector3d(0, -0.02, 0), Vector3d(0, 0.02, 0)};
  proved.grasps = {grasp};
  const GraspObject object = ObjectOf(assets::BoxMesh({0.05, 0.04, 0.08}), 0.25);
  const GraspSet set = MakeGraspSet(object, "solid.obj", PandaGripper(), proved);
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "grasps.json";
  core::WriteFile(file, core::JsonText(GraspSetJson(set)));
  const GraspSet read = ReadGraspSet(file);
  ASSERT_EQ(read.grasps.size(), 1u);
  EXPECT_TRUE(read.grasps[0].object_from_tool.isApprox(grasp.object_from_tool, 1e-12));
  EXPECT_EQ(read.grasps[0].quality, grasp.quality);
  EXPECT_EQ(read.grasps[0].contacts[1], grasp.contacts[1]);
  EXPECT_EQ(read.coverage, set.coverage);
  EXPECT_EQ(read.gripper, "panda");
  // GraspGen: z along the approach, x along the closing axis, 103.4 mm behind the fingertips.
  const Isometry3d base = GraspGenPose(read, read.grasps[0]);
  EXPECT_TRUE(base.linear().col(2).isApprox(grasp.Approach(), 1e-9));
  EXPECT_TRUE(base.linear().col(0).isApprox(grasp.object_from_tool.linear().col(1), 1e-9));
  EXPECT_NEAR((base * Vector3d(0, 0, 0.1034) - grasp.object_from_tool.translation()).norm(), 0.0,
              1e-9);
  core::WriteFile(file, "{\"format\": \"other\"}");
  EXPECT_NE(ErrorOf([&] { ReadGraspSet(file); }).find("is not a grasps.json"), std::string::npos);
}

}  // namespace
}  // namespace simwright::manipulation
