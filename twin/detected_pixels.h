#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::twin {

// The detector's answer by pixel, rows from the top.
struct DetectedPixels {
  int width = 0, height = 0;
  std::vector<float> object;            // probability that the pixel shows an object
  std::vector<float> centre;            // heat of the objects' centres, [0, 1]
  std::vector<Eigen::Vector2f> offset;  // pixels, from the pixel to the centre of its object
};

// The object that each pixel shows, and the heat of the objects' centres.
struct PixelGroups {
  std::vector<int> group;     // by pixel: index of the object, or -1
  std::vector<float> centre;  // by object
};

// Groups the pixels of objects by the peak of the centres' heat that is nearest to where their
// offset points. Groups of few pixels are left out.
PixelGroups GroupPixels(const DetectedPixels& pixels);

}  // namespace simwright::twin
