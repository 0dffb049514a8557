#pragma once

#include "capture/capture_mat.h"
#include "core/camera.h"
#include "core/float_image.h"
#include "core/image.h"

namespace simwright::capture {

// The comparison of a photo with the mat that it should show, per pixel.
struct MatEvidence {
  core::FloatImage albedo;  // (H x W x 1) of the mat, dark 0, light 1; -1 beside it
  core::FloatImage margin;  // (H x W x 1) 1 on the page's margin, beside what is printed
  // (H x W x 1) the distance of the photo's colour from the mat's, in units of the deviation that
  // noise and shadows explain; -1 beside the mat.
  core::FloatImage difference;
  // (H x W x 1) the correlation of the photo with the mat's pattern in a window, in [-1, 1]; 0
  // where the pattern is even.
  core::FloatImage pattern;
  core::Image expected;  // (H x W x 3) the mat's colour in the photo's light without soft shadows
};

// Compares a photo (RGB, without distortion) with the mat seen by its camera (mat frame).
// `print_scale`: MatCalibrationInput. The mat's two colours are measured in the photo, place by
// place, where the pattern is recognised, so uneven light and soft shadows count as mat. Throws
// core::Error if photo and camera differ in size, or the photo has no colours.
MatEvidence CompareWithMat(const core::Image& photo, const core::Camera& camera,
                           const CaptureMat& mat, double print_scale);

}  // namespace simwright::capture
