#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "capture/mat_calibration.h"
#include "core/finding.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::capture {

// The photos of one object, read one by one: two dozen photos of 12 megapixels do not fit into a
// small memory together.
struct CaptureSource {
  struct Photo {
    std::string name;         // used in findings
    double focal_35mm = 0.0;  // mm; 0: unknown
  };
  std::vector<Photo> photos;
  // Reads photo `index`; the same one may be read several times, from several threads.
  std::function<core::Image(int index)> read;
};

struct CaptureOptions {
  double print_scale = 1.0;  // the printed ruler's length over its nominal one
  int first_side = 480;      // pixels of the longer side of a photo's crop in the first round ...
  int crop_side = 720;       // ... and in the second
  int hull_cells = 128;      // along the longest side of the hull
  // The share of the views whose masks may exclude a point of the object.
  double tolerated_views = 0.05;
};

// A photo's part that shows the object, without distortion, with its mask.
struct CaptureView {
  core::Image photo;    // RGB
  core::Camera camera;  // mat frame, m
  core::FloatImage opacity;
  int index = 0;  // of the source's photo
};

// The cameras and masks of an object's photos.
struct Capture {
  std::vector<CaptureView> views;
  core::TriangleMesh hull;         // mat frame, m: the object stands on z = 0
  std::optional<PaperSize> paper;  // the mat's; none: without a mat, in a frame of arbitrary scale
  MatCalibration calibration;      // its views are those of `views`
  core::Findings findings;  // the photos that were left out, and why; what would improve the shape
};

// Finds the cameras of photos of an object on a mat, and segments the object by all views together:
// the mat's pattern gives first masks, their hull limits the second ones. Photos that show no mat
// are left out with a finding, and those whose mask contradicts the others'. Throws core::Error if
// fewer than four photos show the mat, nothing stands on it, or the masks agree in less than half
// of the photos; core::Cancelled.
Capture CaptureOnMat(const CaptureSource& source, const CaptureOptions& options,
                     core::Progress* progress);

}  // namespace simwright::capture
