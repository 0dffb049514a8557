#include "assets/usd_asset.h"

#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "assets/usd_material.h"
#include "assets/usd_prim.h"
#include "assets/usd_tree.h"
#include "core/error.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/sample_asset.h"
#include "tests/assets/usd_text.h"

namespace simwright::assets {
namespace {

void ExpectInertial(const std::string& prim, const Inertial& inertial) {
  EXPECT_NEAR(NumberOf(prim, "physics:mass"), inertial.mass, 1e-7 * inertial.mass);
  EXPECT_TRUE(VectorOf(prim, "physics:centerOfMass").isApprox(inertial.center_of_mass, 1e-6));
  const Eigen::Matrix3d axes = RotationOf(prim, "physics:principalAxes").toRotationMatrix();
  const Eigen::Vector3d moments = VectorOf(prim, "physics:diagonalInertia");
  const Eigen::Matrix3d inertia = axes * moments.asDiagonal() * axes.transpose();
  EXPECT_LT((inertia - inertial.inertia).norm(), 1e-6 * inertial.inertia.norm());
}

TEST(UsdNames, AreValidUniqueAndNeverEmpty) {
  UsdNames names;
  EXPECT_EQ(names.Unique("door"), "door");
  EXPECT_EQ(names.Unique("door"), "door_2");
  EXPECT_EQ(names.Unique("7 up!"), "_7_up_");
  EXPECT_EQ(names.Unique("Tür"), "T__r");
  EXPECT_EQ(names.Unique(""), "_");
  EXPECT_EQ(names.Unique("door_2"), "door_2_2");
}

TEST(UsdText, StringsAndFilesAreQuoted) {
  EXPECT_EQ(UsdString("a \"b\" \\ c"), R"("a \"b\" \\ c")");
  EXPECT_EQ(UsdString("two\nlines\x01"), "\"two lines \"");
  EXPECT_EQ(UsdString("\xff"), "\"\xef\xbf\xbd\"");
  EXPECT_EQ(UsdAsset("./a.png"), "@./a.png@");
  EXPECT_EQ(UsdAsset("./a@b.png"), "@@@./a@b.png@@@");
  EXPECT_EQ(UsdFloat(-0.0), "0");
}

TEST(UsdMaterialPrim, ColoursAreLinear) {
  const core::Material grey{"grey", {0.5f, 0.5f, 0.5f, 1.0f}, -1};
  UsdPrim looks("Scope", "looks");
  looks.Add(UsdMaterial("/a/looks", "grey", grey, nullptr, {}));
  std::string text;
  looks.AppendTo(0, &text);
  // IEC 61966-2-1: 0.5 in sRGB is 0.21404 of the light.
  EXPECT_NEAR(VectorOf(text, "inputs:diffuseColor").x(), 0.214041, 1e-6);
  const core::Material damaged{"damaged", {1.0f, 1.0f, 1.0f, 1.0f}, 3};
  EXPECT_THROW(UsdMaterial("/a/looks", "damaged", damaged, nullptr, {}), core::Error);
}

TEST(UsdAssetText, ARigidAssetKeepsItsInertialAndContact) {
  Asset asset = SampleAsset();
  asset.name = "2 Sample-asset";
  asset.rolling_friction = 0.0004;
  const UsdFiles files = UsdOf(asset, {});
  EXPECT_NE(files.text.find("defaultPrim = \"_2_Sample_asset\""), std::string::npos);
  EXPECT_NE(files.text.find("displayName = \"2 Sample-asset\""), std::string::npos);
  ExpectInertial(files.text, asset.inertial);
  EXPECT_NEAR(NumberOf(files.text, "physics:staticFriction"), asset.friction, 1e-8);
  EXPECT_NEAR(NumberOf(files.text, "physics:restitution"), asset.restitution, 1e-8);
  EXPECT_NEAR(NumberOf(files.text, "newton:rollingFriction"), 0.0004, 1e-11);
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    const std::string part = PrimText(files.text, "collision_00" + std::to_string(i));
    EXPECT_NE(part.find("physics:approximation = \"convexHull\""), std::string::npos) << i;
    EXPECT_EQ(NumbersOf(part, "points").size(), 3 * asset.parts[i].vertices.size());
    EXPECT_EQ(NumbersOf(part, "faceVertexIndices").size(), 3 * asset.parts[i].triangles.size());
  }
  ASSERT_EQ(files.images.size(), asset.visual.textures.size());
}

TEST(UsdAssetText, AHingeTurnsAboutItsAxisBetweenItsLimits) {
  const ArticulatedAsset asset = SampleArticulated();
  const std::string text = UsdOf(asset).text;
  EXPECT_NE(text.find("PhysicsArticulationRootAPI"), std::string::npos);
  EXPECT_EQ(text.find("\"held\""), std::string::npos);
  for (const ArticulatedLink& link : asset.links) {
    ExpectInertial(PrimText(text, link.name), link.inertial);
  }
  const Joint& hinge = asset.joints.front();
  const std::string joint = PrimText(text, "door_joint");
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  EXPECT_TRUE((RotationOf(joint, "physics:localRot0") * x)
                  .isApprox(hinge.parent_from_joint.linear() * hinge.axis, 1e-6));
  EXPECT_TRUE((RotationOf(joint, "physics:localRot1") * x).isApprox(hinge.axis, 1e-6));
  EXPECT_TRUE(
      VectorOf(joint, "physics:localPos0").isApprox(hinge.parent_from_joint.translation(), 1e-6));
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  EXPECT_EQ(NumberOf(joint, "physics:lowerLimit"), 0.0);
  EXPECT_NEAR(NumberOf(joint, "physics:upperLimit"), 1.7 * kDegrees, 1e-5);
  EXPECT_NEAR(NumberOf(joint, "drive:angular:physics:damping"), 0.12 / kDegrees, 1e-9);
  EXPECT_NEAR(NumberOf(joint, "newton:friction"), 0.34, 1e-8);
  // The handle's pose in the asset: that of the door, and then its own.
  EXPECT_TRUE(VectorOf(PrimText(text, "handle_0"), "xformOp:translate")
                  .isApprox(Eigen::Vector3d(-0.153, -0.17, 0.25), 1e-12));
}

// Newton's schemas state in degrees what a joint has in radians.
TEST(UsdAssetText, JointsHaveLimitsOfVelocityAndFollowOthersOfTheirKind) {
  ArticulatedAsset asset = SampleArticulated();
  const std::string hinge = PrimText(UsdOf(asset).text, "door_joint");
  EXPECT_NEAR(NumberOf(hinge, "newton:velocityLimit"), 5.0 * 180.0 / std::numbers::pi, 1e-5);
  EXPECT_EQ(hinge.find("NewtonMimicAPI"), std::string::npos);
  Joint& handle = asset.joints[1];
  handle.type = JointType::kContinuous;
  handle.mimic = {"door_joint", -2.0, 0.25};
  EXPECT_TRUE(HasUsdMimic(asset.joints, handle));
  const std::string follower = PrimText(UsdOf(asset).text, "handle_0_joint");
  EXPECT_NE(follower.find("NewtonMimicAPI"), std::string::npos);
  EXPECT_NE(follower.find("newton:mimicJoint = </sample_chest/joints/door_joint>"),
            std::string::npos);
  EXPECT_EQ(NumberOf(follower, "newton:mimicCoef1"), -2.0);
  EXPECT_NEAR(NumberOf(follower, "newton:mimicCoef0"), 0.25 * 180.0 / std::numbers::pi, 1e-6);
  handle.type = JointType::kPrismatic;  // its leader turns
  EXPECT_FALSE(HasUsdMimic(asset.joints, handle));
  EXPECT_EQ(UsdOf(asset).text.find("NewtonMimicAPI"), std::string::npos);
}

TEST(UsdTreeFindings, SayWhatALayerDoesNotExpress) {
  ArticulatedAsset asset = SampleArticulated();
  const auto codes = [&](bool fixed) {
    std::vector<std::string> found;
    for (const core::Finding& f : UsdTreeFindings(*MakeKinematicModel(asset), fixed)) {
      found.push_back(f.code + " " + f.place);
    }
    return found;
  };
  EXPECT_TRUE(codes(false).empty());
  asset.links[0].inertial.mass = 0.0;
  asset.links[2].inertial.mass = 0.0;  // on a fixed joint: the door carries it
  EXPECT_EQ(codes(false), std::vector<std::string>{"usd-massless-link body"});
  EXPECT_TRUE(codes(true).empty());
  Joint& handle = asset.joints[1];
  asset.links[2].inertial.mass = 0.1;
  handle.mimic = {"door_joint", 1.0, 0.0};
  handle.type = JointType::kRevolute;
  EXPECT_EQ(codes(true), std::vector<std::string>{"usd-mimic-of-newton handle_0_joint"});
  handle.type = JointType::kPrismatic;
  EXPECT_EQ(codes(true), std::vector<std::string>{"usd-mimic-left-out handle_0_joint"});
  handle.mimic.reset();
  handle.type = JointType::kPlanar;
  EXPECT_EQ(codes(true), std::vector<std::string>{"usd-joint-left-out handle_0_joint"});
}

TEST(UsdAssetText, AFixedAssetIsHeldAndExcludedPairsAreFiltered) {
  ArticulatedAsset asset = SampleArticulated();
  asset.fixed = true;
  asset.excluded_pairs = {{"body", "handle_0"}};
  const std::string text = UsdOf(asset).text;
  EXPECT_NE(PrimText(text, "held").find("physics:body1 = </sample_chest/body>"), std::string::npos);
  EXPECT_NE(PrimText(text, "body").find("physics:filteredPairs = [</sample_chest/handle_0>]"),
            std::string::npos);
  asset.joints.front().parent = "nothing";
  EXPECT_THROW(UsdOf(asset), core::Error);
}

TEST(UsdAssetText, LinksThatShareAPictureShareItsFile) {
  const ArticulatedAsset asset = TexturedArticulated();
  const UsdFiles files = UsdOf(asset);
  size_t textures = 0;
  for (const ArticulatedLink& link : asset.links) textures += link.visual.textures.size();
  ASSERT_GT(textures, 0u);
  EXPECT_LE(files.images.size(), textures);
  for (const UsdFiles::ImageFile& image : files.images) {
    EXPECT_NE(files.text.find("@" + image.path + "@"), std::string::npos);
  }
}

}  // namespace
}  // namespace simwright::assets
