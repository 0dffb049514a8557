#include "workflows/lift/video_photos.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "capture/video_frames.h"
#include "core/image.h"

namespace simwright::workflows {
namespace {

constexpr int kFrameJpegQuality = 95;
// A video of which less can be read, of the frames that its file states, was cut short.
constexpr double kWholeShare = 0.95;

std::string FixedPoint(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// Returns the times in seconds, with as many decimals as they need to differ.
std::vector<std::string> TimeLabels(const std::vector<capture::VideoFrame>& frames) {
  std::vector<std::string> labels;
  for (int digits = 1; digits <= 4; ++digits) {
    labels.clear();
    for (const capture::VideoFrame& frame : frames) {
      labels.push_back(FixedPoint(frame.seconds, digits) + " s");
    }
    if (std::set<std::string>(labels.begin(), labels.end()).size() == labels.size()) break;
  }
  return labels;
}

}  // namespace

bool IsVideo(const std::filesystem::path& path) {
  return capture::NamesVideo(path);
}

VideoPhotos::VideoPhotos(const std::filesystem::path& video, int count, core::Progress* progress)
    : name_(video.filename().string()) {
  capture::VideoFrameOptions options;
  options.frames = count;
  const capture::VideoChoice choice = capture::ChooseVideoFrames(video, options, progress);
  const std::vector<std::string> labels = TimeLabels(choice.frames);
  const auto take = [&](const capture::VideoFrame&, const core::Image& picture) {
    photos_.push_back(folder_.path() / (name_ + " " + labels[photos_.size()]));
    core::WriteFile(photos_.back(), core::EncodeJpeg(picture, kFrameJpegQuality));
  };
  capture::ReadVideoFrames(video, choice.frames, take, progress);
  const double sharpness =
      std::min_element(choice.frames.begin(), choice.frames.end(),
                       [](const auto& a, const auto& b) { return a.sharpness < b.sharpness; })
          ->sharpness;
  const bool cut_short = choice.count < kWholeShare * choice.stated_count;
  finding_ = {"video-frames", cut_short ? core::Severity::kWarning : core::Severity::kInfo, name_,
              std::to_string(photos_.size()) + " of " + std::to_string(choice.count) +
                  " frames are used, from " + labels.front() + " to " + labels.back() +
                  "; their sharpness is at least " + FixedPoint(sharpness, 2) +
                  " of the median of the video" +
                  (cut_short ? "; the file states " + std::to_string(choice.stated_count) +
                                   " frames, and the rest cannot be read"
                             : ""),
              sharpness};
}

std::string VideoPhotos::source() const {
  return std::to_string(photos_.size()) + " frames of " + name_;
}

}  // namespace simwright::workflows
