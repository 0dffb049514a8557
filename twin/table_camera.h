#pragma once

#include <string>

#include "core/camera.h"

namespace simwright::twin {

// A camera above a table in the numbers that a photo determines. The world's origin is the point of
// the table's plane, z = 0, below the camera; z is up, and the camera looks towards +y.
struct TableCamera {
  double elevation = 0.6;               // rad, of the optical axis below the horizon
  double roll = 0.0;                    // rad, about the optical axis
  double focal = 0.9;                   // over the picture's width
  double height = 0.5;                  // m, above the table
  Eigen::Vector2d principal{0.5, 0.5};  // point, in widths and heights of the picture

  // Returns the camera of a picture with square pixels.
  core::Camera At(int width, int height_pixels) const;
  // Returns false, with the reason, for numbers that no photo of a table has: an elevation outside
  // 3 to 88 degrees, a roll beyond 45 degrees, a focal length outside 0.3 to 10 or a height outside
  // 5 cm to 20 m.
  bool IsValid(std::string* error) const;
};

// Returns the numbers of a camera that looks down onto the plane z = 0. Throws core::Error if it
// does not.
TableCamera TableCameraOf(const core::Camera& camera);

// The numbers with their uncertainties: mean absolute errors, of focal length and height those of
// their logarithms; 0: known. By default those of photos that people take of tables.
struct TableCameraGuess {
  TableCamera camera;
  double elevation_error = 0.18, roll_error = 0.03, log_focal_error = 0.2, log_height_error = 0.4;
};

}  // namespace simwright::twin
