// Frames of videos, on small ones that are written here.
#include "capture/video_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "core/error.h"
#include "core/files.h"

namespace simwright::capture {
namespace {
namespace fs = std::filesystem;

constexpr int kWidth = 320, kHeight = 240;
constexpr double kRate = 25.0;  // frames a second

// A blotchy wall, of which each frame shows a window.
cv::Mat BlotchyWall() {
  cv::Mat wall(kHeight, 8 * kWidth, CV_8UC3);
  cv::RNG random(7);
  random.fill(wall, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(wall, wall, {}, 2.0);
  cv::normalize(wall, wall, 0, 255, cv::NORM_MINMAX);
  return wall;
}

struct VideoShot {
  double offset = 0.0;  // pixels of the window
  bool blurred = false;
};

void WriteVideo(const fs::path& path, int backend, const char* codec,
                const std::vector<VideoShot>& shots) {
  const cv::Mat wall = BlotchyWall();
  cv::VideoWriter writer(path.string(), backend,
                         cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), kRate,
                         {kWidth, kHeight});
  ASSERT_TRUE(writer.isOpened());
  for (const VideoShot& shot : shots) {
    cv::Mat frame;
    cv::getRectSubPix(wall, {kWidth, kHeight},
                      {static_cast<float>(0.5 * kWidth + shot.offset), 0.5f * kHeight}, frame);
    if (shot.blurred) cv::GaussianBlur(frame, frame, {}, 4.0);
    writer.write(frame);
  }
}

void WriteAvi(const fs::path& path, const std::vector<VideoShot>& shots) {
  WriteVideo(path, cv::CAP_OPENCV_MJPEG, "MJPG", shots);
}

// The camera pans for 100 frames, stands still for 200, and pans for 100 more; two of three panned
// frames are blurred.
std::vector<VideoShot> PanStandPan() {
  std::vector<VideoShot> shots;
  double offset = 0.0;
  for (int i = 0; i < 400; ++i) {
    const bool pans = i < 100 || i >= 300;
    if (pans) offset += 6.0;
    shots.push_back({offset, pans && i % 3 != 0});
  }
  return shots;
}

std::string RefusalOf(const fs::path& path) {
  core::Progress silent;
  try {
    ChooseVideoFrames(path, {}, &silent);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "accepted";
}

// The chosen frames of that video.
class PanVideo : public testing::Test {
 protected:
  PanVideo() {
    WriteAvi(path_, shots_);
    choice_ = ChooseVideoFrames(path_, {}, &silent_);
  }

  const core::TemporaryFolder folder_;
  const fs::path path_ = folder_.path() / "pan.avi";
  const std::vector<VideoShot> shots_ = PanStandPan();
  core::Progress silent_;
  VideoChoice choice_;
};

TEST_F(PanVideo, TakesSharpFramesOfEachPartOfTheWay) {
  EXPECT_EQ(choice_.count, 400);
  EXPECT_NEAR(choice_.motion, 200 * 6.0 / kWidth, 0.3);
  EXPECT_GE(choice_.frames.size(), 28u);
  EXPECT_LE(choice_.frames.size(), 30u);
  int standing = 0, before = -1;
  double last_offset = -1.0;
  for (const VideoFrame& frame : choice_.frames) {
    EXPECT_GT(frame.index, before);
    before = frame.index;
    EXPECT_NEAR(frame.seconds, frame.index / kRate, 1e-3);
    const VideoShot& shot = shots_[static_cast<std::size_t>(frame.index)];
    EXPECT_FALSE(shot.blurred) << frame.index;
    EXPECT_GT(frame.sharpness, 0.7);
    standing += frame.index >= 100 && frame.index < 300;
    // A part of the way is 40 pixels.
    if (last_offset >= 0.0) {
      EXPECT_LE(shot.offset - last_offset, 85.0);
    }
    last_offset = shot.offset;
  }
  EXPECT_LE(standing, 2);
}

TEST_F(PanVideo, ReadsTheFramesThatItChose) {
  const cv::Mat wall = BlotchyWall();
  std::size_t read = 0;
  const auto take = [&](const VideoFrame& frame, core::Image picture) {
    EXPECT_EQ(frame.index, choice_.frames[read++].index);
    ASSERT_EQ(picture.width, kWidth);
    ASSERT_EQ(picture.height, kHeight);
    // The wall at the frame's offset, in RGB.
    double difference = 0.0;
    const int left = static_cast<int>(shots_[static_cast<std::size_t>(frame.index)].offset);
    for (int x = 10; x < kWidth - 10; ++x) {
      for (int c = 0; c < 3; ++c) {
        difference += std::abs(picture.At(x, 100)[c] - wall.at<cv::Vec3b>(100, left + x)[2 - c]);
      }
    }
    EXPECT_LT(difference / (3 * (kWidth - 20)), 12.0) << frame.index;
  };
  ReadVideoFrames(path_, choice_.frames, take, &silent_);
  EXPECT_EQ(read, choice_.frames.size());
}

// The file still states all frames: a caller can tell that some are missing.
TEST_F(PanVideo, ACutFileStatesMoreFramesThanItHolds) {
  const std::string bytes = core::ReadFile(path_);
  const fs::path cut = folder_.path() / "cut.avi";
  core::WriteFile(cut, bytes.substr(0, bytes.size() * 7 / 10));
  const VideoChoice choice = ChooseVideoFrames(cut, {}, &silent_);
  EXPECT_EQ(choice_.stated_count, 400);
  EXPECT_EQ(choice_.count, 400);
  EXPECT_EQ(choice.stated_count, 400);
  EXPECT_LT(choice.count, 380);
  EXPECT_GT(choice.count, 100);
}

TEST(VideoFrames, RefusesOptionsThatAskForNoFrames) {
  core::Progress silent;
  VideoFrameOptions options;
  options.frames = 0;
  EXPECT_THROW(ChooseVideoFrames("pan.avi", options, &silent), core::Error);
}

TEST(VideoFrames, ScoresFewFramesOfALongVideo) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / "long.avi";
  std::vector<VideoShot> shots;
  for (int i = 0; i < 400; ++i) shots.push_back({4.0 * i, false});
  WriteAvi(path, shots);
  core::Progress silent;
  VideoFrameOptions options;
  options.frames = 12;
  options.scored_frames = 40;
  const VideoChoice choice = ChooseVideoFrames(path, options, &silent);
  EXPECT_EQ(choice.count, 400);
  EXPECT_EQ(choice.frames.size(), 12u);
  for (const VideoFrame& frame : choice.frames) EXPECT_EQ(frame.index % 10, 0);
}

TEST(VideoFrames, TurnsFramesUpright) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / "turned.mp4";
  std::vector<VideoShot> shots;
  for (int i = 0; i < 60; ++i) shots.push_back({8.0 * i, false});
  WriteVideo(path, cv::CAP_FFMPEG, "mp4v", shots);
  // A phone states a quarter turn in the matrix of the track's header: 16.16 numbers a, b, u, c, d.
  std::string bytes = core::ReadFile(path);
  const std::size_t header = bytes.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  const std::string quarter("\0\0\0\0\0\1\0\0\0\0\0\0\xff\xff\0\0\0\0\0\0", 20);
  bytes.replace(header + 44, quarter.size(), quarter);
  core::WriteFile(path, bytes);
  core::Progress silent;
  const VideoChoice choice = ChooseVideoFrames(path, {}, &silent);
  int read = 0;
  const auto take = [&](const VideoFrame&, const core::Image& picture) {
    EXPECT_EQ(picture.width, kHeight);
    EXPECT_EQ(picture.height, kWidth);
    ++read;
  };
  ReadVideoFrames(path, choice.frames, take, &silent);
  EXPECT_GE(read, 8);
}

TEST(VideoFrames, RefusesFilesThatAreNoVideoOfAMovingCamera) {
  const core::TemporaryFolder folder;
  const fs::path text = folder.path() / "text.mp4", empty = folder.path() / "empty.mp4",
                 none = folder.path() / "none.avi", few = folder.path() / "few.avi",
                 still = folder.path() / "still.avi", shaky = folder.path() / "shaky.avi";
  core::WriteFile(text, "This is a text, not a video.\n");
  core::WriteFile(empty, "");
  WriteAvi(none, {});
  WriteAvi(few, std::vector<VideoShot>(5));
  WriteAvi(still, std::vector<VideoShot>(100));
  std::vector<VideoShot> shots;
  for (int i = 0; i < 200; ++i) shots.push_back({20.0 + 3.0 * std::sin(1.3 * i), false});
  WriteAvi(shaky, shots);
  EXPECT_NE(RefusalOf(text).find("text.mp4: it is not a video"), std::string::npos);
  EXPECT_NE(RefusalOf(empty).find("empty.mp4: it is not a video"), std::string::npos);
  EXPECT_NE(RefusalOf(folder.path() / "missing.mp4").find("no such file"), std::string::npos);
  EXPECT_NE(RefusalOf(none).find("none.avi"), std::string::npos) << RefusalOf(none);
  EXPECT_NE(RefusalOf(few).find("only 5 frames"), std::string::npos) << RefusalOf(few);
  EXPECT_NE(RefusalOf(still).find("hardly moves"), std::string::npos) << RefusalOf(still);
  EXPECT_NE(RefusalOf(shaky).find("hardly moves"), std::string::npos) << RefusalOf(shaky);
  for (const fs::path& path : {text, empty, none, few, still, shaky}) {
    EXPECT_EQ(RefusalOf(path).find('\n'), std::string::npos);
  }
}

TEST(VideoFrames, KnowsVideosByTheirNames) {
  EXPECT_TRUE(NamesVideo("a/turn.mp4"));
  EXPECT_TRUE(NamesVideo("IMG_0001.MOV"));
  EXPECT_FALSE(NamesVideo("photo.jpg"));
  EXPECT_FALSE(NamesVideo("mp4"));
}

}  // namespace
}  // namespace simwright::capture
