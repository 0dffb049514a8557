#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "capture/feature_tracks.h"
#include "capture/lens.h"
#include "core/finding.h"
#include "core/progress.h"

namespace simwright::capture {

struct StructureInput {
  struct Photo {
    int width = 0, height = 0;  // pixels
    double focal_35mm = 0.0;    // mm; 0: unknown
    std::string name;           // used in findings
  };
  std::vector<Photo> photos;
  std::vector<FeatureTrack> tracks;

  // Throws core::Error, naming the value, for fewer than three photos, photos without pixels, or
  // tracks that name a photo twice or one that does not exist.
  void Validate() const;
};

struct StructureOptions {
  double inlier_pixels = 3.0;      // of a photo of 1600 pixels; larger photos in proportion
  double least_angle = 0.03;       // rad, between the rays to a point
  double first_pair_angle = 0.25;  // rad, the median between the rays of the first pair
  int least_points = 16;           // seen by a photo that is added
};

// Cameras and points in a frame of unknown pose and scale.
struct Structure {
  struct View {
    bool registered = false;  // false: the photo could not be placed
    int lens = 0;             // index into `lenses`
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
    int points = 0;      // that it sees
    double error = 0.0;  // root mean square reprojection error, pixels
  };
  struct Point {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    int track = 0;  // index into `tracks`
  };
  std::vector<Lens> lenses;  // one per size of photo
  std::vector<View> views;   // one per photo
  std::vector<Point> points;
  // The input's tracks, without observations that contradict their point.
  std::vector<FeatureTrack> tracks;
  double error = 0.0;  // root mean square over all observations, pixels
  core::Findings findings;
};

// Reconstructs cameras and points from tracks, incrementally (Snavely, Seitz and Szeliski 2006; the
// order and filters of Schoenberger and Frahm 2016): an essential matrix for the first pair, then
// photo by photo resection (SQPnP with RANSAC), triangulation, and bundle adjustment with a Huber
// loss (Ceres). All photos of a size share a lens; portrait and landscape photos of one size start
// from each other's. EXIF's focal length, where it is given, is a prior. Photos that cannot be
// placed are reported in the findings. Throws core::Error if the input is invalid or no pair of
// photos can start; core::Cancelled.
Structure ReconstructStructure(StructureInput input, const StructureOptions& options,
                               core::Progress* progress);

}  // namespace simwright::capture
