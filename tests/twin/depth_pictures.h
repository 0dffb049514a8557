#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "core/float_image.h"
#include "core/random.h"
#include "tests/twin/rendered_table.h"

namespace simwright::twin {

// Writes depth (m) as depth cameras do: 16 bits, in steps of `unit`; beyond 10 m nothing.
inline void WriteDepth(const std::filesystem::path& path, const core::FloatImage& depth,
                       double unit = 1e-3) {
  cv::Mat steps(depth.height, depth.width, CV_16U);
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      const double value = *depth.At(x, y) > 10.0f ? 0.0 : *depth.At(x, y) / unit;
      steps.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::lround(value));
    }
  }
  if (!cv::imwrite(path.string(), steps)) throw std::runtime_error("no depth written");
}

// The depth of a rendered table, with the normal noise of a depth camera (m at 1 m; it grows with
// the square of the distance).
inline core::FloatImage DepthOf(const RenderedTable& table, double noise = 0.0) {
  const core::Camera& camera = table.scene.camera;
  core::FloatImage depth(camera.width, camera.height, 1);
  core::Rng rng(7);
  for (std::size_t i = 0; i < depth.values.size(); ++i) {
    const double z = table.picture.depth[i];
    depth.values[i] = static_cast<float>(z > 0.0 ? z + noise * z * z * core::Normal(rng) : 0.0);
  }
  return depth;
}

// The depth of a plane normal . p = distance, in the camera's frame; 0 where it is behind.
inline core::FloatImage DepthOfPlane(const core::Camera& camera, const Eigen::Vector3d& normal,
                                     double distance) {
  core::FloatImage depth(camera.width, camera.height, 1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray((x + 0.5 - camera.cx) / camera.fx,
                                (y + 0.5 - camera.cy) / camera.fy, 1.0);
      const double z = distance / normal.dot(ray);
      *depth.At(x, y) = z > 0.0 && z < 10.0 ? static_cast<float>(z) : 0.0f;
    }
  }
  return depth;
}

}  // namespace simwright::twin
