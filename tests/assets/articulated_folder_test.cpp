#include "assets/articulated_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sdf/sdf.hh>

#include "assets/articulated_writer.h"
#include "assets/asset_folder.h"
#include "assets/joint_gravity_load.h"
#include "assets/joint_poses.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_articulated.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class ArticulatedFolder : public ::testing::Test {
 protected:
  void SetUp() override { WriteArticulatedAsset(SampleArticulated(), folder_.path()); }
  core::TemporaryFolder folder_;
};

TEST_F(ArticulatedFolder, ReadsBackWhatItWrote) {
  const ArticulatedAsset written = SampleArticulated();
  const ArticulatedAsset read = ReadArticulatedAsset(folder_.path());
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.features, written.features);
  EXPECT_EQ(read.fixed, written.fixed);
  ASSERT_EQ(read.links.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const ArticulatedLink &a = read.links[i], &b = written.links[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.densities, b.densities);
    EXPECT_EQ(a.inertial.mass, b.inertial.mass);
    EXPECT_EQ(a.inertial.inertia, b.inertial.inertia);
    ASSERT_EQ(a.parts.size(), 1u);
    EXPECT_EQ(a.parts[0].triangles.size(), b.parts[0].triangles.size());
    EXPECT_EQ(a.visual.mesh.triangles.size(), b.visual.mesh.triangles.size());
    EXPECT_EQ(a.visual.materials.size(), 2u);
  }
  const Joint &a = read.joints[0], &b = written.joints[0];
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_TRUE(a.parent_from_joint.isApprox(b.parent_from_joint, 1e-15));
}

// Links that show one photo share its file; a plain look beside it stays plain.
TEST_F(ArticulatedFolder, LinksShareATexture) {
  const ArticulatedAsset written = TexturedArticulated();
  const core::TemporaryFolder folder;
  WriteArticulatedAsset(written, folder.path());
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    pictures += entry.path().extension() == ".png";
  }
  EXPECT_EQ(pictures, 1);
  const ArticulatedAsset read = ReadArticulatedAsset(folder.path());
  for (size_t i = 0; i < read.links.size(); ++i) {
    const core::TexturedMesh &a = read.links[i].visual, &b = written.links[i].visual;
    ASSERT_EQ(a.textures.size(), 1u);
    EXPECT_EQ(a.textures[0].pixels, b.textures[0].pixels);
    EXPECT_EQ(a.materials[0].texture, 0);
    EXPECT_EQ(a.materials[1].texture, -1);
    EXPECT_EQ(a.materials[1].base_color, b.materials[1].base_color);
    ASSERT_EQ(a.corner_uvs.size(), b.corner_uvs.size());
    // Triangles are written by material: triangle 3 is the last one.
    EXPECT_TRUE(a.corner_uvs[3 * 4].isApprox(b.corner_uvs[3 * 5]));
  }
  EXPECT_EQ(VisualAtPositions(read).textures.size(), 1u);
  // A <material> in the URDF would replace the texture of the mesh file.
  const std::string urdf = core::ReadFile(folder.path() / "sample_chest.urdf");
  EXPECT_EQ(urdf.find("body_visual_000\">"), std::string::npos);
  EXPECT_NE(urdf.find("name=\"body_visual_001\""), std::string::npos);
}

// The path is relative to the folder above, as on a command line.
TEST_F(ArticulatedFolder, ReadsBackByARelativePath) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path().parent_path());
  EXPECT_NO_THROW(ReadArticulatedAsset(folder_.path().filename()));
  EXPECT_NO_THROW(ReadUrdf(folder_.path().filename() / "sample_chest.urdf"));
  fs::current_path(before);
}

TEST_F(ArticulatedFolder, LibsdformatReadsItsJointsPosesAndInertials) {
  const ArticulatedAsset asset = SampleArticulated();
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder_.path() / "sample_chest.sdf").string());
  for (const auto& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_NE(root.Model(), nullptr);
  EXPECT_EQ(root.Model()->LinkCount(), 3u);
  const sdf::Joint* hinge = root.Model()->JointByName("door_joint");
  ASSERT_NE(hinge, nullptr);
  EXPECT_EQ(hinge->Type(), sdf::JointType::REVOLUTE);
  EXPECT_EQ(hinge->Axis()->Lower(), 0.0);
  EXPECT_EQ(hinge->Axis()->Upper(), 1.7);
  EXPECT_EQ(hinge->Axis()->Damping(), 0.12);
  EXPECT_EQ(hinge->Axis()->Friction(), 0.34);
  EXPECT_EQ(hinge->Axis()->Xyz().Z(), -1.0);
  const std::vector<Eigen::Isometry3d> poses = LinkPosesAtZero(ModelOf(asset));
  for (size_t i = 0; i < asset.links.size(); ++i) {
    const sdf::Link* link = root.Model()->LinkByName(asset.links[i].name);
    ASSERT_NE(link, nullptr);
    EXPECT_NEAR(link->Inertial().MassMatrix().Mass(), asset.links[i].inertial.mass, 1e-9);
    ignition::math::Pose3d pose;
    ASSERT_TRUE(link->SemanticPose().Resolve(pose, "__model__").empty());
    const Eigen::Vector3d at(pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z());
    EXPECT_LT((at - poses[i].translation()).norm(), 1e-9) << asset.links[i].name;
  }
}

TEST_F(ArticulatedFolder, UrdfdomReadsItsJointsAndInertials) {
  const ArticulatedAsset asset = SampleArticulated();
  const UrdfModel model = ReadUrdf(folder_.path() / "sample_chest.urdf");
  EXPECT_TRUE(model.findings.empty());
  ASSERT_EQ(model.joints.size(), 2u);
  EXPECT_EQ(model.joints[0].damping, 0.12);
  EXPECT_EQ(model.joints[0].friction, 0.34);
  EXPECT_EQ(model.joints[0].effort, 9.0);
  EXPECT_EQ(model.joints[0].velocity, 5.0);
  EXPECT_EQ(model.joints[0].upper, 1.7);
  EXPECT_FALSE(model.joints[1].Moves());
  for (size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(model.links[i].inertial);
    EXPECT_NEAR((model.links[i].inertial->inertia - asset.links[i].inertial.inertia).norm(), 0.0,
                1e-15);
  }
}

TEST_F(ArticulatedFolder, SemanticsAreInPartNetsForm) {
  EXPECT_EQ(core::ReadFile(folder_.path() / "semantics.txt"),
            "body free body\ndoor hinge door\nhandle_0 fixed handle\n");
  ArticulatedAsset fixed = SampleArticulated();
  fixed.fixed = true;
  EXPECT_EQ(SemanticsText(fixed).substr(0, 16), "body static body");
}

TEST_F(ArticulatedFolder, SameAssetSameBytes) {
  const core::TemporaryFolder other;
  WriteArticulatedAsset(SampleArticulated(), other.path());
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    ++files;
    EXPECT_EQ(core::ReadFile(entry.path()), core::ReadFile(other.path() / entry.path().filename()))
        << entry.path();
  }
  EXPECT_EQ(files, 3 * (1 + 2 * 2) + 6);  // parts, two colours with their .mtl; models and texts
}

TEST_F(ArticulatedFolder, DamagedDescriptionsAreOneError) {
  EXPECT_TRUE(IsArticulatedAssetFolder(folder_.path()));
  EXPECT_THROW(ReadAsset(folder_.path()), core::Error);  // it is not rigid
  const std::string good = core::ReadFile(folder_.path() / "asset.json");
  const auto refuses = [&](std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(folder_.path() / "asset.json") << text.replace(at, from.size(), to);
    EXPECT_THROW(ReadArticulatedAsset(folder_.path()), core::Error) << from << " -> " << to;
  };
  refuses(good, "\"name\": \"door\"", "\"name\": \"../door\"");
  refuses(good, "\"parent\": \"body\"", "\"parent\": \"roof\"");
  refuses(good, "\"revolute\"", "\"sliding\"");
  refuses(good, "door_visual_000.obj", "../../secret.obj");
  refuses(good, "\"format\": 1", "\"format\": 2");
  std::ofstream(folder_.path() / "asset.json") << good.substr(0, good.size() / 2);
  EXPECT_FALSE(IsArticulatedAssetFolder(folder_.path()));
  EXPECT_THROW(ReadArticulatedAsset(folder_.path()), core::Error);
}

TEST(JointPoses, ADoorAndItsHandleSwingAboutTheHinge) {
  const UrdfModel model = ModelOf(SampleArticulated());
  const auto closed = LinkPosesAtZero(model);
  const auto open = LinkPoses(model, {{"door_joint", M_PI / 2}});
  // Closed the handle is 0.37 m beside the hinge, and 0.05 m before it; open by a right angle
  // about -z that is before it and beside it.
  EXPECT_TRUE(closed[2].translation().isApprox(Eigen::Vector3d(-0.153, -0.17, 0.25), 1e-12));
  EXPECT_TRUE(
      open[2].translation().isApprox(Eigen::Vector3d(-0.103 - 0.37, 0.2 + 0.05, 0.25), 1e-12));
}

TEST(JointPoses, MimicsFollowTheirLeader) {
  UrdfModel model = ModelOf(SampleArticulated());
  model.joints[1].type = JointType::kPrismatic;
  model.joints[1].axis = Eigen::Vector3d::UnitX();
  model.joints[1].mimic = {"door_joint", 0.1, 0.02};
  const auto poses = LinkPoses(model, {{"door_joint", 0.5}, {"handle_0_joint", 9.0}});
  const Eigen::Vector3d in_door = poses[1].inverse() * poses[2].translation();
  EXPECT_NEAR(in_door.x(), -0.05 + 0.1 * 0.5 + 0.02, 1e-12);
}

// m g l sin(angle) about a level axis.
TEST(JointLoad, IsTheWeightsMoment) {
  ArticulatedAsset asset = SampleArticulated();
  asset.joints[0].axis = Eigen::Vector3d::UnitX();
  std::vector<Inertial> inertials;
  double moment = 0.0;
  for (const ArticulatedLink& link : asset.links) inertials.push_back(link.inertial);
  moment += inertials[1].mass * 0.2 + inertials[2].mass * 0.37;  // levers along y
  const auto model = MakeKinematicModel(asset);
  const JointLoad load = LoadOn(*model, 0, 0.0);
  EXPECT_NEAR(load.gravity, 9.81 * moment, 1e-9);
  EXPECT_NEAR(LoadOn(*model, 0, 1.0).gravity, 9.81 * moment * std::cos(1.0), 1e-9);
  EXPECT_NEAR(load.mass, inertials[1].mass + inertials[2].mass, 1e-12);
}

}  // namespace
}  // namespace simwright::assets
