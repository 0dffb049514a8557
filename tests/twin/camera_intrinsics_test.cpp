#include "twin/camera_intrinsics.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/files.h"

namespace simwright::twin {
namespace {

class CameraIntrinsicsFile : public ::testing::Test {
 protected:
  CameraIntrinsics Read(const std::string& text, int width = 640, int height = 480) {
    core::WriteFile(folder_.path() / "camera.yaml", text);
    return ReadCameraIntrinsics(folder_.path() / "camera.yaml", width, height);
  }
  std::string Refusal(const std::string& text) {
    try {
      Read(text);
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find("camera.yaml"), std::string::npos) << error.what();
      return error.what();
    }
    return "";
  }
  core::TemporaryFolder folder_;
};

constexpr char kCameraInfo[] = R"(image_width: 1280
image_height: 960
camera_name: narrow  # of the wrist
camera_matrix:
  rows: 3
  cols: 3
  data: [1100.0, 0, 650.5, 0, 1102.0,
         470.25, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.001, -0.002, 0, 0, 0]
)";

TEST_F(CameraIntrinsicsFile, IsScaledToThePhoto) {
  const CameraIntrinsics ros = Read(kCameraInfo);
  EXPECT_NEAR(ros.focal, 1101.0 / 1280.0, 1e-12);
  EXPECT_NEAR(ros.principal.x(), 650.5 / 1280.0, 1e-12);
  EXPECT_NEAR(ros.principal.y(), 470.25 / 960.0, 1e-12);
  EXPECT_TRUE(ros.findings.empty());
  const CameraIntrinsics flat = Read(
      R"({"fx": 600, "fy": 600.0, "cx": 320, "cy": 240, "width": 640, "height": 480})", 1280, 960);
  EXPECT_NEAR(flat.focal, 600.0 / 640.0, 1e-12);
  EXPECT_EQ(flat.principal, Eigen::Vector2d(0.5, 0.5));
  const CameraIntrinsics message = Read(
      "header:\n  seq: 4\nheight: 480\nwidth: 640\nd:\n- 0.0\n- 0.0\nk:\n- 500.0\n- 0.0\n"
      "- 310.0\n- 0.0\n- 500.0\n- 250.0\n- 0.0\n- 0.0\n- 1.0\n");
  EXPECT_NEAR(message.focal, 500.0 / 640.0, 1e-12);
  EXPECT_NEAR(message.principal.x(), 310.0 / 640.0, 1e-12);
  // Rows of a matrix, in JSON, for the photo itself.
  EXPECT_NEAR(Read(R"({"K": [[700, 0, 330], [0, 700, 240], [0, 0, 1]]})").focal, 700.0 / 640.0,
              1e-12);
}

TEST_F(CameraIntrinsicsFile, ReportsWhatAPinholeCannotExpress) {
  const CameraIntrinsics off = Read(R"({"fx": 600, "fy": 600, "cx": 400, "cy": 240})");
  ASSERT_EQ(off.findings.size(), 1u);
  EXPECT_EQ(off.findings[0].code, "twin-principal-point");
  EXPECT_NEAR(off.findings[0].figure, 0.125, 1e-12);
  const CameraIntrinsics bent =
      Read(R"({"fx": 600, "fy": 600, "cx": 320, "cy": 240, "distortion": [-0.31, 0.1]})");
  ASSERT_EQ(bent.findings.size(), 1u);
  EXPECT_EQ(bent.findings[0].code, "twin-distortion");
  EXPECT_NEAR(bent.findings[0].figure, 0.31, 1e-12);
}

TEST_F(CameraIntrinsicsFile, IsRefusedWithTheReason) {
  EXPECT_NE(Refusal("").find("neither fx"), std::string::npos);
  EXPECT_NE(Refusal("{").size(), 0u);
  EXPECT_NE(Refusal("fx: 600\nfy: 600\ncx: 320\n").find("neither cy"), std::string::npos);
  EXPECT_NE(Refusal(R"({"fx": 600, "fy": 500, "cx": 320, "cy": 240})").find("square"),
            std::string::npos);
  EXPECT_NE(Refusal(R"({"fx": -600, "fy": 600, "cx": 320, "cy": 240})").find("positive"),
            std::string::npos);
  EXPECT_NE(Refusal("fx: nan\nfy: 600\ncx: 320\ncy: 240\n").find("positive"), std::string::npos);
  EXPECT_NE(Refusal(R"({"fx": 60, "fy": 60, "cx": 320, "cy": 240})").find("focal"),
            std::string::npos);
  EXPECT_NE(Refusal(R"({"fx": 600, "fy": 600, "cx": 20, "cy": 240})").find("principal"),
            std::string::npos);
  EXPECT_NE(Refusal(R"({"fx": 600, "fy": 600, "cx": 320, "cy": 240, "width": 640, "height": 640})")
                .find("aspect"),
            std::string::npos);
  EXPECT_NE(Refusal(R"({"K": [700, 3, 330, 4, 700, 240, 0, 0, 1]})").find("rows"),
            std::string::npos);
}

}  // namespace
}  // namespace simwright::twin
