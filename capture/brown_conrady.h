#pragma once

namespace simwright::capture {

// The free values of a lens with square pixels, in the order in which Ceres sees them.
enum LensValue { kFocal, kCenterX, kCenterY, kK1, kK2, kP1, kP2, kK3, kLensValues };

// Projects a point of the camera's frame (3) by the lens values (kLensValues) to pixels (2): the
// formula of capture/lens.h, for numbers with derivatives.
template <typename T>
void ProjectByLens(const T* lens, const T* point, T* pixel) {
  const T x = point[0] / point[2], y = point[1] / point[2];
  const T r2 = x * x + y * y;
  const T radial = T(1.0) + r2 * (lens[kK1] + r2 * (lens[kK2] + r2 * lens[kK3]));
  pixel[0] =
      lens[kFocal] * (x * radial + T(2.0) * lens[kP1] * x * y + lens[kP2] * (r2 + T(2.0) * x * x)) +
      lens[kCenterX];
  pixel[1] =
      lens[kFocal] * (y * radial + lens[kP1] * (r2 + T(2.0) * y * y) + T(2.0) * lens[kP2] * x * y) +
      lens[kCenterY];
}

}  // namespace simwright::capture
