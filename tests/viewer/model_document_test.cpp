#include "viewer/model_document.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/sample_asset.h"
#include "viewer/grasp_file.h"
#include "viewer/world_document.h"

namespace simwright::viewer {
namespace {

// A box of known sides, turned, about a centre.
assets::Inertial BoxInertial(const Eigen::Vector3d& sides, double mass,
                             const Eigen::Matrix3d& turn) {
  const Eigen::Vector3d squares = sides.cwiseAbs2();
  const Eigen::Vector3d moments =
      mass / 12.0 *
      Eigen::Vector3d(squares.y() + squares.z(), squares.z() + squares.x(),
                      squares.x() + squares.y());
  return {mass, {0.1, -0.2, 0.3}, turn * moments.asDiagonal() * turn.transpose()};
}

TEST(EquivalentBox, OfABoxIsTheBox) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const assets::Inertial inertial = BoxInertial({0.3, 0.1, 0.2}, 2.5, turn);
  const EquivalentBox box = EquivalentBoxOf(inertial);
  Eigen::Vector3d sides = box.size;
  std::sort(sides.data(), sides.data() + 3);
  EXPECT_LT((sides - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_LT((box.link_from_box.translation() - inertial.center_of_mass).norm(), 1e-15);
  EXPECT_NEAR(box.link_from_box.linear().determinant(), 1.0, 1e-12);
  const assets::Inertial again =
      BoxInertial(box.size, 2.5, Eigen::Matrix3d(box.link_from_box.linear()));
  EXPECT_LT((again.inertia - inertial.inertia).norm(), 1e-12);
}

TEST(EquivalentBox, WithoutMassIsNothing) {
  EXPECT_EQ(EquivalentBoxOf({0.0, {}, {}}).size, Eigen::Vector3d::Zero());
}

TEST(ModelDocument, ARigidAssetHasItsLayers) {
  DocumentBuilder builder("asset", "sample");
  const assets::Asset asset = assets::SampleAsset();
  const core::OrderedJson model = ModelOf(asset, &builder);
  EXPECT_EQ(model["name"], "sample_box");
  ASSERT_EQ(model["links"].size(), 1u);
  const core::OrderedJson& link = model["links"][0];
  for (const char* layer : {"visual", "solid", "parts"}) EXPECT_EQ(link[layer].size(), 1u) << layer;
  EXPECT_EQ(link["mass"].get<double>(), asset.inertial.mass);
  EXPECT_EQ(link["center_of_mass"][2].get<double>(), asset.inertial.center_of_mass.z());
  EXPECT_TRUE(model["joints"].empty());
  // Solid and part are one mesh; the visual differs in its material.
  EXPECT_EQ(link["solid"], link["parts"]);
  EXPECT_EQ(builder.Take().buffers.size(), 2u);
}

TEST(ModelDocument, AnArticulatedAssetHasItsTree) {
  DocumentBuilder builder("asset", "sample");
  const assets::ArticulatedAsset asset = assets::SampleArticulated();
  const core::OrderedJson model = ModelOf(asset, &builder);
  ASSERT_EQ(model["links"].size(), asset.links.size());
  ASSERT_EQ(model["joints"].size(), asset.joints.size());
  for (std::size_t i = 0; i < asset.joints.size(); ++i) {
    const assets::Joint& joint = asset.joints[i];
    const core::OrderedJson& json = model["joints"][i];
    EXPECT_EQ(json["name"], joint.name);
    const auto parent = json["parent"].get<std::size_t>();
    EXPECT_EQ(model["links"][parent]["name"], joint.parent);
    EXPECT_EQ(model["links"][i + 1]["name"], joint.child);
    for (int k = 0; k < 12; ++k) {
      EXPECT_EQ(json["parent_from_joint"][static_cast<std::size_t>(k)].get<double>(),
                joint.parent_from_joint.matrix()(k / 4, k % 4));
    }
    EXPECT_EQ(json["upper"].get<double>(), joint.upper);
  }
}

class Grasps : public ::testing::Test {
 protected:
  core::OrderedJson Read(const std::string& text, std::size_t most = 400) {
    core::WriteFile(folder_.path() / "grasps.json", text);
    return ReadGrasps(folder_.path() / "grasps.json", most);
  }
  core::TemporaryFolder folder_;
};

constexpr const char* kTwoGrasps =
    R"({"grasps": {"tool_transforms": [[[1,0,0,0.1],[0,1,0,0],[0,0,1,0],[0,0,0,1]],
        [[0,-1,0,0.2],[1,0,0,0],[0,0,1,0.3],[0,0,0,1]]], "quality": [0.25, 0.75]}})";

TEST_F(Grasps, TheBestComeFirst) {
  const core::OrderedJson grasps = Read(kTwoGrasps);
  EXPECT_EQ(grasps["count"], 2);
  EXPECT_EQ(grasps["qualities"][0], 0.75);
  EXPECT_EQ(grasps["poses"][0][1], -1.0);
  EXPECT_EQ(grasps["poses"][0][11], 0.3);
  EXPECT_EQ(grasps["poses"][1][3], 0.1);
  EXPECT_EQ(Read(kTwoGrasps, 1)["poses"].size(), 1u);
}

TEST_F(Grasps, LinksFollowTheirPoses) {
  std::string text = kTwoGrasps;
  text.insert(text.rfind("}}"), R"(, "link": ["handle_0", "handle_1"])");
  const core::OrderedJson grasps = Read(text);
  EXPECT_EQ(grasps["links"][0], "handle_1");
  EXPECT_EQ(grasps["links"][1], "handle_0");
  EXPECT_FALSE(Read(kTwoGrasps).contains("links"));
}

TEST_F(Grasps, PosesOfAHandLeadToItsFingertips) {
  // A hand that approaches from above at the origin: x closes, z points down.
  const core::OrderedJson grasps = Read(
      R"({"grasps": {"transforms": [[[1,0,0,0],[0,-1,0,0],[0,0,-1,0.2],[0,0,0,1]]],
          "object_in_gripper": [true]}})");
  const core::OrderedJson& pose = grasps["poses"][0];
  EXPECT_NEAR(pose[11].get<double>(), 0.2 - 0.1034, 1e-12) << "the fingertips are below the hand";
  EXPECT_NEAR(pose[1].get<double>(), 1.0, 1e-12) << "the tool's y is the hand's x";
  EXPECT_NEAR(pose[10].get<double>(), -1.0, 1e-12);
  EXPECT_EQ(grasps["qualities"][0], 1.0);
  EXPECT_EQ(grasps["openings"][0], 0.08);
}

TEST_F(Grasps, DamagedFilesAreRefused) {
  EXPECT_THROW(Read("{}"), core::Error);
  EXPECT_THROW(Read("not JSON"), core::Error);
  EXPECT_THROW(Read(R"({"grasps": {"transforms": [[1, 2, 3]]}})"), core::Error);
  EXPECT_THROW(Read(R"({"grasps": {"transforms": [[[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]}})"),
               core::Error)
      << "a scaling is no rigid motion";
  EXPECT_THROW(Read(R"({"grasps": {"transforms": [[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]],
               "quality": [1, 2]}})"),
               core::Error);
}

// A file that is cut off anywhere, or has another byte anywhere, is read or refused.
TEST_F(Grasps, MutilatedFilesAreReadOrRefused) {
  const std::string text = kTwoGrasps;
  int refused = 0;
  const auto read = [&](const std::string& mutilated) {
    try {
      Read(mutilated);
    } catch (const core::Error&) {
      ++refused;
    }
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    read(text.substr(0, at));
    for (const char byte : {'9', '"', '[', '-', '\0', '\xff'}) {
      std::string changed = text;
      changed[at] = byte;
      read(changed);
    }
  }
  EXPECT_GT(refused, static_cast<int>(text.size()));
}

TEST(WorldDocument, ATimelineCountsItsFrames) {
  Timeline timeline;
  timeline.width = 9;
  timeline.tracks.push_back({0, 0, {"a", "b"}, 7});
  for (int frame = 0; frame < 5; ++frame) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = frame;
    AppendPose(pose, &timeline.rows);
    timeline.rows.insert(timeline.rows.end(), {0.5f, -0.5f});
  }
  const core::OrderedJson json = TimelineJson(timeline);
  EXPECT_EQ(json["frames"], 5);
  EXPECT_EQ(json["tracks"][0]["joint_columns"], 7);
  EXPECT_EQ(TimelineBytes(timeline).size(), 5u * 9 * 4);
  EXPECT_EQ(timeline.rows[9 * 4], 4.0f);
  EXPECT_EQ(timeline.rows[9 * 4 + 6], 1.0f) << "the quaternion's w";
}

}  // namespace
}  // namespace simwright::viewer
