#pragma once

#include <vector>

#include <Eigen/Core>

#include "texture/delighting.h"

namespace simwright::texture {

// Pixels of an object, in rows, that a photo and a mesh agree on.
struct ObjectPixels {
  int width = 0, height = 0;
  std::vector<int> at;                  // (K) positions in the picture
  std::vector<int> index;               // (width x height) into `at`, or -1
  std::vector<Eigen::Vector3f> color;   // (K) linear RGB
  std::vector<Eigen::Vector3f> normal;  // (K) unit, world, facing the camera
  std::vector<float> openness;          // (K) ambient, [0, 1]
  std::vector<float> facing;            // (K) cosine to the viewer

  int count() const { return static_cast<int>(at.size()); }
};

// Returns the chromaticity (r, g) of a colour, its share of the sum.
Eigen::Vector2f Chromaticity(const Eigen::Vector3f& color);

// Returns the brightness that pairs compare: the mean of the channels.
float Brightness(const Eigen::Vector3f& color);

// Returns the grey light (9) whose shading explains the ratios of pairs of pixels
// (DelightPhoto). Its shading has mean 1 over the pixels.
Eigen::Matrix<float, 9, 1> FitGreyLight(const ObjectPixels& pixels, const std::vector<char>& usable,
                                        const DelightingOptions& options);

// Returns the shading of each pixel under a grey light, at least `least`.
std::vector<float> ShadingOf(const ObjectPixels& pixels, const Eigen::Matrix<float, 9, 1>& light,
                             float least);

}  // namespace simwright::texture
