#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/files.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::workflows {

// Returns whether the file's name ends like that of a video.
bool IsVideo(const std::filesystem::path& path);

// Frames of a video as photo files, which live as long as the object. They are named after the
// video and the time in it: "turn.mp4 12.3 s".
class VideoPhotos {
 public:
  // Chooses at most `count` frames. Throws core::Error as capture::ChooseVideoFrames does, or if
  // the frames cannot be written; core::Cancelled.
  VideoPhotos(const std::filesystem::path& video, int count, core::Progress* progress);

  const std::vector<std::filesystem::path>& photos() const { return photos_; }
  // Returns the words for the frames in the asset's record: "30 frames of turn.mp4".
  std::string source() const;
  // Returns the finding "video-frames": the number of frames, and their sharpness.
  const core::Finding& finding() const { return finding_; }

 private:
  std::string name_;
  core::TemporaryFolder folder_;
  std::vector<std::filesystem::path> photos_;
  core::Finding finding_;
};

}  // namespace simwright::workflows
