#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "capture/lens.h"
#include "capture/mat_detection.h"
#include "core/finding.h"

namespace simwright::capture {

struct MatCalibrationInput {
  // A photo's corners, and its 35 mm-equivalent focal length (mm; 0: unknown).
  struct Photo {
    MatObservation mat;
    double focal_35mm = 0.0;
    std::string name;  // used in findings
  };
  std::vector<Photo> photos;
  double print_scale = 1.0;  // the printed ruler's length over its nominal one

  // Throws core::Error, naming the photo and the value, for fewer than kMinCalibrationPhotos
  // photos, mats of several paper sizes, indices out of range or print_scale outside [0.5, 2].
  void Validate() const;
};
constexpr int kMinCalibrationPhotos = 4;

struct MatCalibration {
  struct View {
    int lens = 0;                                                         // index into `lenses`
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  // mat frame, m
    double error = 0.0;  // root mean square reprojection error of the used corners, pixels
  };
  std::vector<Lens> lenses;  // one per size of photo: all photos of a size share one
  std::vector<View> views;   // one per photo
  double error = 0.0;        // root mean square of the views' errors, pixels
  core::Findings findings;
};

// Fits the intrinsics, the lens distortion and the camera poses to the mat's corners: bundle
// adjustment of the reprojection errors with a Huber loss of one pixel (Ceres). The mat's points
// are known, so they fix the gauge and the metric scale. The focal length starts from EXIF where it
// is given, else from the homographies. k3 is fitted from 12 photos on. Corners with an error over
// 2 pixels that stand out are dropped: something hides them in part. Throws core::Error if the
// input is invalid, or the corners do not determine the cameras.
MatCalibration CalibrateOnMat(const MatCalibrationInput& input);

}  // namespace simwright::capture
