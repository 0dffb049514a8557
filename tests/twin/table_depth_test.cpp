#include "twin/table_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/depth_image.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "tests/twin/depth_pictures.h"

namespace simwright::twin {
namespace {

constexpr double kTestDegree = M_PI / 180.0;

std::string Refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

RenderedTable SetTable(const TableCamera& camera) {
  return RenderKinds({{"cereal_box", 1'000'000'012, 0.12, 1.05, 0.5},
                      {"mug", 1'000'000'011, -0.1, 0.8, -0.6},
                      {"plate", 1'000'000'014, 0.1, 0.75, 0.0}},
                     camera);
}

// The plane of a rendered table with known cameras, through a file in millimetres.
TEST(FitTablePlane, GivesElevationRollAndHeight) {
  const core::TemporaryFolder folder;
  for (const TableCamera& truth :
       {TableCamera{0.62, 0.0, 1.15, 0.7}, TableCamera{0.35, 0.12, 1.0, 0.45},
        TableCamera{1.0, -0.2, 1.3, 1.1}, TableCamera{0.7, 0.05, 1.1, 0.8, {0.56, 0.45}}}) {
    const core::FloatImage depth = DepthOf(SetTable(truth));
    WriteDepth(folder.path() / "depth.png", depth);
    TableCamera lens;
    lens.focal = truth.focal;
    lens.principal = truth.principal;
    const DepthPlane plane =
        FitTablePlane(core::ReadDepthImage(folder.path() / "depth.png"), lens, 1, "depth.png");
    EXPECT_NEAR(plane.camera.elevation, truth.elevation, 0.5 * kTestDegree);
    EXPECT_NEAR(plane.camera.roll, truth.roll, 0.5 * kTestDegree);
    EXPECT_NEAR(plane.camera.height / truth.height, 1.0, 0.01);
    EXPECT_EQ(plane.camera.focal, truth.focal);
    EXPECT_GT(plane.share, 0.5);
    EXPECT_LT(plane.error, 0.002);
  }
}

TEST(FitTablePlane, ToleratesTheNoiseOfADepthCamera) {
  const TableCamera truth{0.62, 0.05, 1.15, 0.7};
  TableCamera lens;
  lens.focal = truth.focal;
  const DepthPlane plane = FitTablePlane(DepthOf(SetTable(truth), 0.004), lens, 1, "");
  EXPECT_NEAR(plane.camera.elevation, truth.elevation, 0.5 * kTestDegree);
  EXPECT_NEAR(plane.camera.roll, truth.roll, 0.5 * kTestDegree);
  EXPECT_NEAR(plane.camera.height / truth.height, 1.0, 0.01);
  EXPECT_GT(plane.error, 0.002);
}

// Walls: straight ahead, seen from the side, and seen by a camera that looks down by 30 degrees.
TEST(FitTablePlane, RefusesAWall) {
  TableCamera lens;
  const core::Camera camera = lens.At(320, 240);
  const double tilt = 30.0 * kTestDegree;
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(std::sin(tilt), 0, std::cos(tilt)),
        Eigen::Vector3d(0, -std::sin(tilt), std::cos(tilt))}) {
    const core::FloatImage wall = DepthOfPlane(camera, normal, 1.4);
    const std::string refusal = Refusal([&] { FitTablePlane(wall, lens, 1, "wall.png"); });
    EXPECT_NE(refusal.find("wall.png: the depth shows no table"), std::string::npos) << refusal;
  }
}

TEST(FitTablePlane, RefusesDisorder) {
  core::FloatImage depth(160, 120, 1);
  core::Rng rng(3);
  for (float& value : depth.values) value = static_cast<float>(core::Uniform(rng, 0.3, 4.0));
  const std::string refusal = Refusal([&] { FitTablePlane(depth, TableCamera(), 1, "noise"); });
  EXPECT_NE(refusal.find("no table"), std::string::npos) << refusal;
}

TEST(DepthOfPhoto, TakesTheNearestPixelOfTheSameAspect) {
  core::FloatImage depth(4, 2, 1);
  for (int i = 0; i < 8; ++i) depth.values[static_cast<std::size_t>(i)] = 1.0f + i;
  const core::FloatImage twice = DepthOfPhoto(depth, 8, 4, "d");
  EXPECT_EQ(*twice.At(0, 0), 1.0f);
  EXPECT_EQ(*twice.At(1, 1), 1.0f);
  EXPECT_EQ(*twice.At(2, 0), 2.0f);
  EXPECT_EQ(*twice.At(7, 3), 8.0f);
  const core::FloatImage half = DepthOfPhoto(twice, 4, 2, "d");
  EXPECT_EQ(half.values, depth.values);
  EXPECT_NE(Refusal([&] { DepthOfPhoto(depth, 4, 3, "d.png"); }).find("another aspect"),
            std::string::npos);
  EXPECT_NE(Refusal([&] {
              DepthOfPhoto(core::FloatImage(40, 20, 1), 40, 20, "d.png");
            }).find("all are 0"),
            std::string::npos);
}

TEST(ReadDepthImage, ReadsStepsAndRefusesOtherPictures) {
  const core::TemporaryFolder folder;
  const auto path = [&](const char* name) { return folder.path() / name; };
  core::FloatImage depth(3, 2, 1);
  depth.values = {0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 6.5f};
  WriteDepth(path("mm.png"), depth);
  const core::FloatImage read = core::ReadDepthImage(path("mm.png"));
  ASSERT_EQ(read.width, 3);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(read.values[i], depth.values[i], 1e-6);
  WriteDepth(path("fine.png"), depth, 1e-4);
  EXPECT_NEAR(core::ReadDepthImage(path("fine.png"), 1e-4).values[5], 6.5, 1e-5);
  core::WritePng(path("8.png"), core::Image(3, 2, 1, 90));
  EXPECT_NE(Refusal([&] { core::ReadDepthImage(path("8.png")); }).find("16 bits"),
            std::string::npos);
  cv::imwrite(path("rgb.png").string(), cv::Mat(2, 3, CV_16UC3, cv::Scalar(1, 2, 3)));
  EXPECT_NE(Refusal([&] { core::ReadDepthImage(path("rgb.png")); }).find("colour"),
            std::string::npos);
  const std::string bytes = core::ReadFile(path("mm.png"));
  core::WriteFile(path("cut.png"), bytes.substr(0, bytes.size() - 20));
  EXPECT_NE(Refusal([&] { core::ReadDepthImage(path("cut.png")); }), "");
  core::WriteFile(path("text.png"), "depth");
  EXPECT_NE(Refusal([&] { core::ReadDepthImage(path("text.png")); }), "");
  EXPECT_NE(Refusal([&] { core::ReadDepthImage(path("none.png")); }), "");
}

}  // namespace
}  // namespace simwright::twin
