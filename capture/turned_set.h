#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "capture/capture.h"
#include "core/progress.h"

namespace simwright::capture {

// The pose of an object that was turned over between two sets of photos.
struct TurnedPose {
  Eigen::Isometry3d first_from_second = Eigen::Isometry3d::Identity();
  // The mean IoU of all masks of both sets with the silhouettes of the common hull.
  double agreement = 0.0;
  // The root mean square difference of the sets' colours on the surface, natural logarithm, and
  // that of the best other pose whose outlines agree as well; without one, no value.
  double color_difference = 0.0;
  std::optional<double> rival_difference;
  std::string doubt;  // why the pose is not to be trusted; empty: it is
};

// Finds the pose of the second set's object in the first set's frame: poses of all rotations are
// compared by outlines (outline_alignment.h), and those that agree equally well by colours. Both
// captures are in metres. Throws core::Error for captures without hull; core::Cancelled.
TurnedPose FindTurnedPose(const Capture& first, const Capture& second, std::uint64_t seed,
                          core::Progress* progress);

// Adds the second set's views, in the first set's frame, to the first, and makes the hull of both:
// flat only where the object stands in either set. The added views' photos are numbered from
// `first_photo` on.
void MergeTurned(const Capture& second, const Eigen::Isometry3d& first_from_second, int first_photo,
                 const CaptureOptions& options, Capture* first);

}  // namespace simwright::capture
