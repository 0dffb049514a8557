#include "asset_build/true_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "importers/up_axis.h"

namespace simwright::asset_build {
namespace {

core::TriangleMesh TrueSizeTurned(const Eigen::Vector3d& sides, double degrees) {
  core::TriangleMesh mesh = assets::BoxMesh(sides);
  const Eigen::AngleAxisd turn(degrees * M_PI / 180.0, Eigen::Vector3d::UnitZ());
  core::Transform(Eigen::Affine3d(turn), &mesh);
  return mesh;
}

TEST(TrueSize, AThingThatLiesAcrossIsAsLongAsItIs) {
  for (const double degrees : {0.0, 30.0, 45.0, 90.0, 135.0}) {
    const GroundBox box = GroundBoxOf(TrueSizeTurned({0.3, 0.03, 0.02}, degrees));
    EXPECT_NEAR(box.sides.head<2>().maxCoeff(), 0.3, 1e-9) << degrees;
    EXPECT_NEAR(box.sides.head<2>().minCoeff(), 0.03, 1e-9) << degrees;
    EXPECT_NEAR(box.sides.z(), 0.02, 1e-12) << degrees;
  }
  EXPECT_EQ(GroundBoxOf(assets::SphereMesh(0.1, 20)).angle, 0.0);
}

TEST(TrueSize, AStatedSizeIsKeptAlongTheThingsOwnAxes) {
  core::Findings findings;
  core::TriangleMesh mesh = TrueSizeTurned({0.3, 0.03, 0.02}, 30.0);
  ScaleToSize({0.36}, "hammer", &mesh, &findings);
  EXPECT_NEAR(GroundBoxOf(mesh).sides.maxCoeff(), 0.36, 1e-9);
  EXPECT_TRUE(findings.empty());
  ScaleToSize({0.4, 0.1, 0.05}, "hammer", &mesh, &findings);
  const Eigen::Vector3d sides = GroundBoxOf(mesh).sides;
  EXPECT_NEAR(sides.head<2>().maxCoeff(), 0.4, 1e-6);
  EXPECT_NEAR(sides.head<2>().minCoeff(), 0.1, 1e-6);
  EXPECT_NEAR(sides.z(), 0.05, 1e-9);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "stretched");
  for (const StatedSize& wrong : {StatedSize{0.1, 0.2}, StatedSize{-1.0}, StatedSize{NAN}}) {
    EXPECT_THROW(Validate(wrong), core::Error);
  }
}

TEST(TrueSize, AnAbsurdSizeNamesTheUnitThatFits) {
  const physics_params::Category& chair =
      *physics_params::KnowledgeBase::Shipped().FindCategory("chair");
  try {
    RequirePlausibleSize(chair, {45, 50, 89.5}, 1.0, "chair.glb");
    FAIL();
  } catch (const core::Error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("45 x 50 x 89.5 m"), std::string::npos) << what;
    EXPECT_NE(what.find("--unit cm makes it 0.45 x 0.5 x 0.895 m"), std::string::npos) << what;
  }
  EXPECT_NO_THROW(RequirePlausibleSize(chair, {0.45, 0.5, 0.895}, 1.0, "chair.glb"));
}

// The up axis of a format that does not specify it, by proportions and by stability.
TEST(UpAxis, IsGuessedWhereTheOtherClearlySuitsBetter) {
  const auto& base = physics_params::KnowledgeBase::Shipped();
  const auto guess = [&](const char* file, const char* category, const Eigen::Vector3d& sides,
                         core::Severity* severity) {
    core::Findings findings;
    const char up = importers::GuessUpAxis(file, assets::BoxMesh(sides),
                                           *base.FindCategory(category), &findings);
    *severity = findings.empty() ? core::Severity::kError : findings[0].severity;
    return up;
  };
  core::Severity said;
  EXPECT_EQ(guess("a.obj", "bottle", {0.07, 0.07, 0.3}, &said), 'z');
  EXPECT_EQ(said, core::Severity::kWarning);
  EXPECT_EQ(guess("a.obj", "bottle", {0.07, 0.3, 0.07}, &said), 'y');
  EXPECT_EQ(said, core::Severity::kInfo);
  EXPECT_EQ(guess("a.stl", "bottle", {0.07, 0.3, 0.07}, &said), 'y');
  EXPECT_EQ(guess("a.ply", "plate", {0.25, 0.25, 0.02}, &said), 'z');
  EXPECT_EQ(guess("a.obj", "plate", {0.25, 0.25, 0.02}, &said), 'z');
  EXPECT_EQ(guess("a.obj", "object", {0.2, 0.3, 0.25}, &said), 'y');
  // glTF and DAE specify it: there is no guess and no finding.
  EXPECT_EQ(guess("a.glb", "bottle", {0.07, 0.07, 0.3}, &said), 'y');
  EXPECT_EQ(said, core::Severity::kError);
}

}  // namespace
}  // namespace simwright::asset_build
