#include "capture/video_frames.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <string>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <opencv2/videoio.hpp>

#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr int kSharpnessSide = 480;  // pixels of the longer side of the pictures compared ...
constexpr int kMotionSide = 240;     // ... and of those between which motion is measured
constexpr int kLeastSide = 100;      // pixels of a video's shorter side
// The part of the picture that may stand still while the rest counts as motion: an object on a
// turntable fills a small part.
constexpr double kStillPart = 0.9;
// Smaller moves, in sides of the picture, do not count: a hand is never quite still.
constexpr double kLeastMove = 0.02;
constexpr double kLeastSharpness = 0.2;  // of the median

// FFmpeg would print errors of its own beside ours, and follow addresses that a file names.
void PrepareFfmpeg() {
  static std::once_flag once;
  std::call_once(once, [] {
    constexpr int kKeep = 0;  // of a value that the user set
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", kKeep);
    setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "protocol_whitelist;file", kKeep);
  });
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

// The frames of a video file, one after the other.
class VideoStream {
 public:
  explicit VideoStream(const std::filesystem::path& path);
  // Goes to the next frame. Returns false at the end.
  bool Next();
  // Returns the current frame, upright, BGR.
  cv::Mat Decode();
  int index() const { return index_; }
  double seconds();
  // Returns the number of frames that the file states, which may be wrong; 0: unknown.
  int StatedCount();

 private:
  core::Error Unreadable() const {
    return {"it is not a video that can be read", name_,
            "convert it to MP4 (H.264), or give photos"};
  }

  std::string name_;
  cv::VideoCapture video_;
  int index_ = -1;
};

VideoStream::VideoStream(const std::filesystem::path& path) : name_(path.string()) {
  if (!std::filesystem::is_regular_file(path)) throw core::Error("there is no such file", name_);
  PrepareFfmpeg();
  try {
    // An absolute path is never taken for an address.
    if (!video_.open(std::filesystem::absolute(path).string(), cv::CAP_FFMPEG)) throw Unreadable();
    video_.set(cv::CAP_PROP_ORIENTATION_AUTO, 1.0);
  } catch (const cv::Exception&) {
    throw Unreadable();
  }
}

bool VideoStream::Next() {
  core::CheckCancelled();
  if (!video_.grab()) return false;
  ++index_;
  return true;
}

cv::Mat VideoStream::Decode() {
  cv::Mat frame;
  try {
    if (!video_.retrieve(frame) || frame.type() != CV_8UC3) throw Unreadable();
  } catch (const cv::Exception&) {
    throw Unreadable();
  }
  if (std::min(frame.cols, frame.rows) < kLeastSide) {
    throw core::Error("its pictures have only " + std::to_string(frame.cols) + " x " +
                          std::to_string(frame.rows) + " pixels",
                      name_, "film at a higher resolution");
  }
  return frame;
}

double VideoStream::seconds() {
  const double stamp = 0.001 * video_.get(cv::CAP_PROP_POS_MSEC);
  if (index_ == 0 || (std::isfinite(stamp) && stamp > 0.0)) return std::max(0.0, stamp);
  const double rate = video_.get(cv::CAP_PROP_FPS);
  return rate > 0.0 ? index_ / rate : 0.0;
}

int VideoStream::StatedCount() {
  const double count = video_.get(cv::CAP_PROP_FRAME_COUNT);
  return count > 0.0 && count < 1e8 ? static_cast<int>(count) : 0;
}

cv::Mat ScaledGrey(const cv::Mat& frame, cv::Size size) {
  cv::Mat scaled, grey;
  cv::resize(frame, scaled, size, 0.0, 0.0, cv::INTER_AREA);
  cv::cvtColor(scaled, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Size SizeOfSide(const cv::Mat& frame, int side) {
  const double scale = static_cast<double>(side) / std::max(frame.cols, frame.rows);
  return {std::max(1, static_cast<int>(std::lround(scale * frame.cols))),
          std::max(1, static_cast<int>(std::lround(scale * frame.rows)))};
}

// Returns the variance of the Laplacian.
double LaplacianVariance(const cv::Mat& grey) {
  cv::Mat laplacian;
  cv::Laplacian(grey, laplacian, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(laplacian, mean, deviation);
  return deviation[0] * deviation[0];
}

// The way of a video's content from frame to frame. It is measured from a frame that is replaced
// after each move that counts, so that small moves to and fro do not add up.
class VideoMotion {
 public:
  // Returns the way up to `frame`, in sides of the picture.
  double WayTo(const cv::Mat& frame);

 private:
  // Returns the length that `kStillPart` of the picture's moves since the last key frame stay
  // below, in sides of the picture.
  double MoveTo(const cv::Mat& grey);

  cv::Ptr<cv::DISOpticalFlow> flow_ =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_ULTRAFAST);
  cv::Mat key_;
  double key_way_ = 0.0, way_ = 0.0;
};

double VideoMotion::WayTo(const cv::Mat& frame) {
  if (key_.empty()) {
    key_ = ScaledGrey(frame, SizeOfSide(frame, kMotionSide));
    return way_;
  }
  const cv::Mat grey = ScaledGrey(frame, key_.size());
  const double move = MoveTo(grey);
  way_ = std::max(way_, key_way_ + move);
  if (move >= kLeastMove) {
    key_ = grey;
    key_way_ = way_;
  }
  return way_;
}

double VideoMotion::MoveTo(const cv::Mat& grey) {
  cv::Mat_<cv::Vec2f> moves;
  flow_->calc(key_, grey, moves);
  std::vector<float> lengths;
  lengths.reserve(moves.total() / 4 + 1);
  for (int y = 0; y < moves.rows; y += 2) {
    for (int x = 0; x < moves.cols; x += 2) {
      lengths.push_back(std::hypot(moves(y, x)[0], moves(y, x)[1]));
    }
  }
  const auto at = lengths.begin() +
                  static_cast<std::ptrdiff_t>(kStillPart * static_cast<double>(lengths.size() - 1));
  std::nth_element(lengths.begin(), at, lengths.end());
  return *at / kMotionSide;
}

struct ScoredFrame {
  VideoFrame frame;  // its sharpness is not yet relative to the median
  double way = 0.0;
};

// Keeps every second score.
void ThinScores(std::vector<ScoredFrame>* scored) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scored->size(); i += 2) (*scored)[kept++] = (*scored)[i];
  scored->resize(kept);
}

// Scores at most `most` frames of the whole video, and counts all.
std::vector<ScoredFrame> ScoreFrames(VideoStream* video, const std::string& name, int most,
                                     int* count, core::Progress* progress) {
  const int stated = video->StatedCount();
  int stride = std::max(1, (stated + most - 1) / most);
  int steps = stated / stride;
  progress->Stage("compare the frames of " + name, steps);
  std::vector<ScoredFrame> scored;
  VideoMotion motion;
  while (video->Next()) {
    if (video->index() % stride != 0) continue;
    if (static_cast<int>(scored.size()) == most) {  // more frames than the file states
      ThinScores(&scored);
      stride *= 2;
      if (video->index() % stride != 0) continue;
    }
    const cv::Mat frame = video->Decode();
    const double sharpness =
        LaplacianVariance(ScaledGrey(frame, SizeOfSide(frame, kSharpnessSide)));
    scored.push_back({{video->index(), video->seconds(), sharpness}, motion.WayTo(frame)});
    if (stated == 0 || steps-- > 0) progress->Advance();
  }
  progress->Finish();
  *count = video->index() + 1;
  return scored;
}

double MedianSharpness(const std::vector<ScoredFrame>& scored) {
  std::vector<double> all;
  for (const ScoredFrame& score : scored) all.push_back(score.frame.sharpness);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return std::max(*middle, 1e-9);
}

// Returns the sharpest frame of each of `parts` parts of equal motion.
std::vector<VideoFrame> SharpestOfParts(const std::vector<ScoredFrame>& scored, int parts) {
  const double whole = scored.back().way, median = MedianSharpness(scored);
  std::vector<VideoFrame> sharpest;
  int last_part = -1;
  for (const ScoredFrame& score : scored) {
    const int part = std::min(parts - 1, static_cast<int>(score.way / whole * parts));
    VideoFrame frame = score.frame;
    frame.sharpness /= median;
    if (part != last_part) {
      sharpest.push_back(frame);
    } else if (frame.sharpness > sharpest.back().sharpness) {
      sharpest.back() = frame;
    }
    last_part = part;
  }
  std::erase_if(sharpest,
                [](const VideoFrame& frame) { return frame.sharpness < kLeastSharpness; });
  return sharpest;
}

}  // namespace

bool NamesVideo(const std::filesystem::path& path) {
  static constexpr std::array kEndings = {".mp4",  ".m4v",  ".mov", ".avi",  ".mkv",
                                          ".webm", ".3gp",  ".mts", ".m2ts", ".mpg",
                                          ".wmv",  ".mpeg", ".ogv", ".flv"};
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

VideoChoice ChooseVideoFrames(const std::filesystem::path& path, const VideoFrameOptions& options,
                              core::Progress* progress) {
  if (options.frames < 1 || options.least_frames < 1 || options.scored_frames < 1 ||
      !(options.least_motion > 0.0)) {
    throw core::Error("the numbers of frames and the least motion must be positive");
  }
  const std::string name = path.string();
  VideoStream video(path);
  VideoChoice choice;
  choice.stated_count = video.StatedCount();
  const std::vector<ScoredFrame> scored =
      ScoreFrames(&video, path.filename().string(), options.scored_frames, &choice.count, progress);
  if (scored.empty()) throw core::Error("the video holds no frames", name, "film it again");
  const std::string around = "film the object from all around, slowly, for about a minute";
  if (static_cast<int>(scored.size()) < options.least_frames) {
    throw core::Error("the video holds only " + std::to_string(choice.count) + " frames", name,
                      around);
  }
  choice.motion = scored.back().way;
  if (choice.motion < options.least_motion) {
    throw core::Error("the camera hardly moves in the video", name, around);
  }
  choice.frames = SharpestOfParts(scored, options.frames);
  if (static_cast<int>(choice.frames.size()) < options.least_frames) {
    throw core::Error("only " + std::to_string(choice.frames.size()) +
                          " frames of the video are sharp and differ from each other",
                      name, around);
  }
  return choice;
}

void ReadVideoFrames(const std::filesystem::path& path, const std::vector<VideoFrame>& frames,
                     const std::function<void(const VideoFrame& frame, core::Image picture)>& take,
                     core::Progress* progress) {
  VideoStream video(path);
  // Most of the time passes between the chosen frames.
  progress->Stage("read frames of " + path.filename().string(),
                  frames.empty() ? 0 : frames.back().index + 1);
  for (const VideoFrame& frame : frames) {
    while (video.index() < frame.index) {
      if (!video.Next()) {
        throw core::Error("the video ends before a frame that it held", path.string(), "try again");
      }
      progress->Advance();
    }
    const cv::Mat decoded = video.Decode();
    core::Image picture(decoded.cols, decoded.rows, 3);
    cv::Mat target(picture.height, picture.width, CV_8UC3, picture.pixels.data());
    cv::cvtColor(decoded, target, cv::COLOR_BGR2RGB);
    take(frame, std::move(picture));
  }
  progress->Finish();
}

}  // namespace simwright::capture
