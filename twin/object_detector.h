#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "core/image.h"
#include "twin/table_camera.h"

namespace simwright::twin {

// An object that a photo of a table shows.
struct Detection {
  core::Image alpha;        // 1 channel, the photo's size: the visible part of the object
  Eigen::AlignedBox2d box;  // pixels, of that part
  double confidence = 0.0;  // mean probability that its pixels show an object, times that of its
                            // centre, [0, 1]
  bool cut = false;         // reaches the photo's border
};

struct Detections {
  std::vector<Detection> objects;  // the largest first
  TableCameraGuess camera;
  double object_share = 0.0;  // of the photo's pixels
  int left_out = 0;           // places that look like objects, with too little confidence
};

// Finds the objects in a photo of a table by one small network, in less than a second a photo. The
// camera of its answer is the usual one of such photos.
class ObjectDetector {
 public:
  // Throws core::Error where the weights are missing or damaged.
  explicit ObjectDetector(const std::filesystem::path& weights);
  ~ObjectDetector();
  ObjectDetector(const ObjectDetector&) = delete;
  ObjectDetector& operator=(const ObjectDetector&) = delete;

  // `photo`: RGB, at least 64 pixels a side. Throws core::Error for another picture.
  Detections Detect(const core::Image& photo) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace simwright::twin
