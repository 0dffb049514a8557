#pragma once

#include <cstddef>
#include <vector>

namespace simwright::core {

// A floating-point image: rows from the top, channels interleaved. Its owner defines what the
// values mean (sRGB in [0, 1], metres, a gradient).
struct FloatImage {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> values;  // (height x width x channels)

  FloatImage() = default;
  FloatImage(int w, int h, int c, float value = 0.0f)
      : width(w), height(h), channels(c), values(static_cast<std::size_t>(w) * h * c, value) {}

  bool empty() const { return values.empty(); }
  float* At(int x, int y) { return &values[(static_cast<std::size_t>(y) * width + x) * channels]; }
  const float* At(int x, int y) const {
    return &values[(static_cast<std::size_t>(y) * width + x) * channels];
  }
};

}  // namespace simwright::core
