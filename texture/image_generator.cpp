#include "texture/image_generator.h"

namespace simwright::texture {
namespace {

constexpr int kLeastSide = 64, kMostSide = 4096;

bool HasSize(int width, int height, const core::Image& view) {
  return width == view.width && height == view.height;
}

}  // namespace

bool ImageRequest::IsValid(std::string* error) const {
  const auto fail = [error](const std::string& reason) {
    if (error) *error = reason;
    return false;
  };
  if (prompt.empty() && exemplar.empty()) return fail("neither a prompt nor an exemplar is given");
  if (!exemplar.empty() && exemplar.channels != 3) return fail("the exemplar is no RGB picture");
  if (render.empty()) {
    const auto side_fits = [](int side) { return side >= kLeastSide && side <= kMostSide; };
    if (side_fits(width) && side_fits(height)) return true;
    return fail("the picture's size of " + std::to_string(width) + " x " + std::to_string(height) +
                " is outside 64 to 4096 pixels a side");
  }
  if (render.channels != 3) return fail("the render is no RGB picture");
  if (trimap.channels != 1 || !HasSize(trimap.width, trimap.height, render)) {
    return fail("the trimap is no grey picture of the render's size");
  }
  if (depth.channels != 1 || !HasSize(depth.width, depth.height, render)) {
    return fail("the depth is no grey picture of the render's size");
  }
  if (!HasSize(camera.width, camera.height, render)) {
    return fail("the camera has another size than the render");
  }
  return true;
}

}  // namespace simwright::texture
