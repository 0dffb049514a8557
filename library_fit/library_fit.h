#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "asset_lift/camera/view_frame.h"
#include "core/camera.h"
#include "core/image.h"
#include "library_fit/fit_kinds.h"
#include "library_fit/fit_view.h"
#include "library_fit/library_prior.h"

namespace simwright::library_fit {

// A photo of one object: the photo, its matte (1 channel, the same size), and the crop around the
// object.
struct FitPhoto {
  core::Image photo;
  core::Image alpha;
  asset_lift::ViewFrame frame;
};

// Returns the photo with the crop that the prior expects. Throws core::Error where the matte is
// empty or of another size than the photo.
FitPhoto FitPhotoOf(const core::Image& photo, const core::Image& alpha);

struct LibraryFitOptions {
  std::vector<int> kinds;           // the only kinds considered; empty: all
  int most_kinds = 5;               // fitted: the most probable ones
  double least_probability = 0.01;  // of a kind that is fitted; the most probable always is
  int proposals = 24;               // compared per kind before the search
  int starts = 2;                   // proposals from which the search starts
  int generations = 22;             // of each of its passes
  int side = 80;                    // pixels per side of the crop that is compared
  std::uint64_t seed = 1;

  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

// An object of the library fitted to a photo.
struct FittedInstance {
  Instance instance;
  FitView view;
  double probability = 0.0;  // of the kind, by the network, among all kinds
  double iou = 0.0;          // of the outlines in the crop
  double unexplained = 1.0;  // share of the colours' variance that its parts do not explain
  double edge_error = 1.0;   // mean distance of edges, over three pixels
  // The smaller the better: the loss of the fit plus the improbability of the kind.
  double score = 0.0;
};

// Fits the library's objects to a photo and returns the best fit of each kind considered, the best
// kind first. The network proposes kinds, parameters and views; for each kind the best proposals
// are refined by CMA-ES over view, size and continuous choices, and by trying each value of the
// other choices. Throws core::Error for invalid options, unknown kinds, or an empty matte.
std::vector<FittedInstance> FitLibrary(const LibraryPrior& prior, const FitPhoto& photo,
                                       const LibraryFitOptions& options = {});

// Returns the camera of the fit for the photo's pixels, in the frame of InstanceMesh.
core::Camera PhotoCamera(const FittedInstance& fit, const FitPhoto& photo);

}  // namespace simwright::library_fit
