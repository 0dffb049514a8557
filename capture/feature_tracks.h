#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/progress.h"

namespace simwright::capture {

// A scene point as several photos show it.
struct FeatureTrack {
  std::vector<int> photos;              // (K) ascending, each once
  std::vector<Eigen::Vector2d> pixels;  // (K x 2) image points (core::Camera's convention)
};

// The tracks of photos, and how sharp each photo is.
struct PhotoTracks {
  std::vector<FeatureTrack> tracks;
  // Per photo, the 95th percentile of the change of grey values (of 255) between neighbouring
  // pixels: a blurred photo has a fraction of the others'.
  std::vector<double> sharpness;
};

struct FeatureTrackOptions {
  int max_side = 1600;      // pixels of the longer side at which features are found
  int max_features = 4000;  // per photo, the strongest
  double ratio = 0.8;       // of the distances to the best and the second-best match (Lowe 2004)
  double epipolar_pixels = 2.0;  // at max_side, of an inlier of the fundamental matrix
  int least_matches = 16;        // verified ones, of a pair of photos that counts
};

// Finds features (SIFT) in `count` photos and matches each pair: nearest descriptors both ways, by
// Lowe's ratio, verified by a fundamental matrix (MAGSAC), and then again along its epipolar lines.
// Matches are joined to tracks; a track that meets a photo twice is dropped. `read` returns photo
// i; it is called once a photo, from several threads. Throws core::Error for fewer than two photos;
// core::Cancelled.
PhotoTracks FindFeatureTracks(int count, const std::function<core::Image(int)>& read,
                              const FeatureTrackOptions& options, core::Progress* progress);

}  // namespace simwright::capture
