#include "capture/view_matte.h"

#include <algorithm>
#include <cmath>

namespace simwright::capture {

asset_lift::Matte MatteOf(const CaptureView& view) {
  asset_lift::Matte matte;
  matte.method = "views together";
  matte.alpha = core::Image(view.photo.width, view.photo.height, 1);
  matte.left = view.photo.width;
  matte.top = view.photo.height;
  double sum = 0.0;
  for (int y = 0; y < view.photo.height; ++y) {
    for (int x = 0; x < view.photo.width; ++x) {
      const float share = *view.opacity.At(x, y);
      *matte.alpha.At(x, y) = static_cast<std::uint8_t>(std::lround(255.0f * share));
      sum += share;
      if (share < 0.5f) continue;
      matte.left = std::min(matte.left, x);
      matte.top = std::min(matte.top, y);
      matte.right = std::max(matte.right, x + 1);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
  matte.area = sum / (static_cast<double>(view.photo.width) * view.photo.height);
  return matte;
}

}  // namespace simwright::capture
