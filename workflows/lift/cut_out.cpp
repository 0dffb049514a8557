#include "workflows/lift/cut_out.h"

#include <algorithm>
#include <cmath>

namespace simwright::workflows {

core::Image CutOut(const core::Image& photo, const core::Image& alpha) {
  core::Image cut(photo.width, photo.height, 4);
  for (int y = 0; y < cut.height; ++y) {
    for (int x = 0; x < cut.width; ++x) {
      for (int c = 0; c < 3; ++c) cut.At(x, y)[c] = photo.At(x, y)[photo.channels < 3 ? 0 : c];
      cut.At(x, y)[3] = alpha.At(x, y)[0];
    }
  }
  return cut;
}

core::Image CenteredCutOut(const core::Image& photo, const asset_lift::Matte& matte) {
  constexpr double kFilledShare = 0.85;  // the foreground ratio of TripoSR and Stable Fast 3D
  const int width = matte.right - matte.left, height = matte.bottom - matte.top;
  const int side = static_cast<int>(std::ceil(std::max(width, height) / kFilledShare));
  const int left = (side - width) / 2 - matte.left, top = (side - height) / 2 - matte.top;
  const core::Image cut = CutOut(photo, matte.alpha);
  core::Image square(side, side, 4, 255);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int from_x = x - left, from_y = y - top;
      const bool inside = from_x >= 0 && from_y >= 0 && from_x < cut.width && from_y < cut.height;
      if (inside && cut.At(from_x, from_y)[3] > 0) {
        std::copy_n(cut.At(from_x, from_y), 4, square.At(x, y));
      } else {
        square.At(x, y)[3] = 0;
      }
    }
  }
  return square;
}

}  // namespace simwright::workflows
