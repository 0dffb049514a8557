#pragma once

#include <optional>

#include <Eigen/Core>

#include "capture/structure_from_motion.h"

namespace simwright::capture {

// Limits of a point that its photos agree on.
struct TriangulationLimits {
  double pixels = 3.0;        // of a photo of 1600 pixels; larger photos in proportion
  double least_angle = 0.03;  // rad, between two of its rays
};

// Returns the reprojection error from which an observation in a photo of that lens is wrong,
// pixels.
double ErrorLimit(const Lens& lens, double pixels_of_1600);

// Returns the error of a point in a photo, pixels; infinite behind the camera.
double ReprojectionError(const Structure& structure, int photo, const Eigen::Vector2d& pixel,
                         const Eigen::Vector3d& point);

// Returns the point of a track from the rays of its placed photos, if they agree on one in front of
// them under a sufficient angle. Where all of them do not, the largest set that does decides (at
// least three photos, over half of them), and the other observations leave the track.
std::optional<Eigen::Vector3d> TriangulateTrack(const Structure& structure,
                                                const TriangulationLimits& limits,
                                                FeatureTrack* track);

// Removes the observations of a placed point that are over the limit. Returns false if fewer than
// three remain where some were wrong, or no two of its rays have a sufficient angle: then the point
// is wrong.
bool KeepAgreeing(const Structure& structure, const TriangulationLimits& limits,
                  const Eigen::Vector3d& point, FeatureTrack* track);

}  // namespace simwright::capture
