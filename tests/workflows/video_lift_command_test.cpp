// `simwright lift` of a video.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "core/json.h"
#include "program.h"
#include "tests/capture/mat_photos.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr double kTurn = 2.0 * std::numbers::pi;

// Writes a video of a box on the mat: the camera climbs on a spiral of two turns.
void WriteSpiral(const fs::path& path, const Eigen::Vector3d& sides) {
  constexpr int kShots = 60;
  capture::MatPhotoOptions options;
  options.lens = capture::PhoneLens(800, 600, 65.0 / 360.0 * kTurn);
  std::vector<Eigen::Isometry3d> poses;  // of the sharp frames
  for (int i = 0; i < kShots; ++i) {
    if (i % 3 == 1) continue;
    const double share = static_cast<double>(i) / kShots;
    poses.push_back(core::OrbitCamera({0.0, 0.0, 0.03}, 0.42, (15.0 + 45.0 * share) / 360.0 * kTurn,
                                      2.0 * kTurn * share, 1.0, 800, 600)
                        .world_from_camera);
  }
  cv::VideoWriter writer(path.string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, {800, 600});
  const auto photos =
      capture::RenderMatPhotos(capture::PlainBox(sides, {0.85f, 0.6f, 0.2f}), poses, options);
  std::size_t next = 0;
  for (int i = 0; i < kShots; ++i) {
    // Every third frame is blurred: it is the frame before it, out of focus.
    const bool blurred = i % 3 == 1;
    core::Image photo = photos[blurred ? next - 1 : next++].photo;
    cv::Mat frame(photo.height, photo.width, CV_8UC3, photo.pixels.data());
    cv::cvtColor(frame, frame, cv::COLOR_RGB2BGR);
    if (blurred) cv::GaussianBlur(frame, frame, {}, 3.0);
    writer.write(frame);
  }
}

TEST(VideoLift, GivesTheTrueSizeFromFramesNamedAfterTheirTime) {
  const core::TemporaryFolder folder;
  const fs::path video = folder.path() / "turn.avi", asset = folder.path() / "carton";
  const Eigen::Vector3d sides(0.06, 0.045, 0.09);  // m
  WriteSpiral(video, sides);
  const Outcome lift =
      RunProgram("lift " + video.string() + " --category box --quiet -o " + asset.string());
  ASSERT_EQ(lift.code, 0) << lift.text;
  const assets::Asset made = assets::ReadAsset(asset);
  const Eigen::Vector3d size = core::Bounds(made.visual.mesh).sizes();
  // The box is about 140 pixels high: the sides come out 4 to 7 mm too long, and 7 to 9 mm by 15
  // of the frames given as photos.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], sides[k], 0.09 * sides.maxCoeff()) << k;
  EXPECT_EQ(std::count_if(made.findings.begin(), made.findings.end(),
                          [](const auto& finding) { return finding.code == "video-frames"; }),
            1);
  EXPECT_NE(core::ReadFile(asset / "asset.json").find("frames of turn.avi on a mat"),
            std::string::npos);
  const core::JsonDocument capture =
      core::JsonDocument::Read(asset / "capture.json", 1 << 20, "lift again");
  int photos = 0;
  for (const core::JsonField& photo : capture.root()["photos"].Elements()) {
    const std::string name = photo["photo"].Text();
    ASSERT_TRUE(name.starts_with("turn.avi ") && name.ends_with(" s")) << name;
    // Ten frames a second, of which every third one is blurred.
    const int index = static_cast<int>(std::lround(10.0 * std::stod(name.substr(9))));
    EXPECT_NE(index % 3, 1) << name;
    ++photos;
  }
  EXPECT_GE(photos, 26);
  EXPECT_LE(photos, 30);
}

TEST(VideoLift, RefusesAFakeVideoAndOptionsItWouldNotUse) {
  const core::TemporaryFolder folder;
  const fs::path video = folder.path() / "fake.mp4", asset = folder.path() / "asset";
  core::WriteFile(video, "This is a text, not a video.\n");
  const auto refusal = [&](const std::string& arguments) {
    const Outcome lift =
        RunProgram("lift " + arguments + " --category mug --quiet -o " + asset.string());
    EXPECT_EQ(lift.code, 1) << arguments;
    EXPECT_EQ(std::count(lift.text.begin(), lift.text.end(), '\n'), 1) << lift.text;
    EXPECT_FALSE(fs::exists(asset));
    return lift.text;
  };
  const std::string name = video.string();
  EXPECT_NE(refusal(name).find("it is not a video that can be read"), std::string::npos);
  EXPECT_NE(refusal(name + " " + name).find("give one video, or photos"), std::string::npos);
  for (const char* option : {"--each", "--fast", "--mask a.png", "--cameras c.json"}) {
    const std::string text = refusal(name + " " + option);
    EXPECT_NE(text.find("is not used with a video"), std::string::npos) << text;
  }
  EXPECT_NE(refusal("photo.jpg --frames 20").find("--frames needs a video"), std::string::npos);
}

}  // namespace
}  // namespace simwright
