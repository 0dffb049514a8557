#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "library_fit/library_prior.h"
#include "twin/object_detector.h"
#include "twin/table_camera.h"
#include "twin/table_fit.h"

namespace simwright::twin {

struct TableReconstructionOptions {
  TableFitOptions fit;
  int side = 80;  // pixels per side of the compared crops
  // The camera is searched for along each of its unknown numbers in turn, this many times.
  int camera_passes = 2;
  // kinds[k]: the only kinds considered for detection k; empty, or shorter: all.
  std::vector<std::vector<int>> kinds;
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// An object of a photo on the table.
struct ReconstructedObject {
  int detection = 0;            // its index
  TableFit fit;                 // metric: of the reconstruction's camera
  double confidence = 0.0;      // [0, 1]: of the detection, its kind and its agreement
  double position_error = 0.0;  // m, one standard deviation in the plane
  double yaw_error = 0.0;       // rad
  double size_error = 0.0;      // of the logarithm
  bool hidden = false;          // partly behind another object or outside of the photo
  // The asset that takes the place of the fitted instance (twin/asset_retrieval.h), or -1; `fit`
  // then has its pose, size and agreement.
  int retrieved = -1;
};

struct TableReconstruction {
  TableCamera camera;
  double log_scale_error = 0.0;  // of all lengths together
  std::vector<ReconstructedObject> objects;
  double outline_error = 0.0;  // mean squared error of the joint refinement
};

// Rebuilds what a photo (RGB) of a table shows: each detection as an object of the library that
// stands on the plane z = 0. Starts from the guessed camera; numbers of the guess without an error
// are known. Elevation, focal length and roll are those with which the fits agree best; the scale
// is that with which the objects have the most usual sizes. Throws core::Error for invalid options
// or a photo without detections, and core::Cancelled.
TableReconstruction ReconstructTable(const core::Image& photo, const Detections& detections,
                                     const library_fit::LibraryPrior& prior,
                                     const TableReconstructionOptions& options,
                                     core::Progress* progress);

}  // namespace simwright::twin
