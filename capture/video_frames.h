#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/image.h"
#include "core/progress.h"

namespace simwright::capture {

struct VideoFrameOptions {
  int frames = 30;       // to choose at most ...
  int least_frames = 8;  // ... and at least
  // Frames that are compared at most: of a longer video, every second, third ... one.
  int scored_frames = 1200;
  // The least way of the picture's content, in sides of the picture: less is a standing camera.
  double least_motion = 0.3;
};

struct VideoFrame {
  int index = 0;           // in the video
  double seconds = 0.0;    // from the video's start
  double sharpness = 0.0;  // over the median of the scored frames
};

struct VideoChoice {
  std::vector<VideoFrame> frames;  // in order
  int count = 0;                   // the frames of the video that can be read
  int stated_count = 0;            // that the file states, often an estimate; 0: unknown
  double motion = 0.0;             // the way of the picture's content, in sides of the picture
};

// Returns whether the file's name ends like that of a video.
bool NamesVideo(const std::filesystem::path& path);

// Chooses frames of a video that serve as photos of a scene: its way is cut into `frames` parts of
// equal motion, so that a camera that stands still gives few, and the sharpest frame of each part
// is taken. A part without a sharp frame gives none. Holds two frames at a time. Throws core::Error
// for options that ask for no frames, and if the file is not a video that can be read, or has too
// few frames or hardly any motion; core::Cancelled.
VideoChoice ChooseVideoFrames(const std::filesystem::path& path, const VideoFrameOptions& options,
                              core::Progress* progress);

// Decodes the chosen frames one by one, upright and in RGB, and hands them to `take`. Throws
// core::Error if the video cannot be read; core::Cancelled.
void ReadVideoFrames(const std::filesystem::path& path, const std::vector<VideoFrame>& frames,
                     const std::function<void(const VideoFrame& frame, core::Image picture)>& take,
                     core::Progress* progress);

}  // namespace simwright::capture
