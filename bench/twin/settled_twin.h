#pragma once

#include <cstdint>

#include "core/image.h"
#include "twin/object_detector.h"
#include "twin/table_reconstruction.h"

namespace simwright::bench {

// The twin of a reconstruction, after physics.
struct SettledTwin {
  bool complete = false;     // each object has an asset
  bool stands = false;       // no object moves in physics
  double penetration = 0.0;  // m, the deepest
  core::Image picture;       // RGB: the photo beside the twin over the darkened photo
};

// Writes the assets of a reconstruction, as simwright twin does, into a temporary folder, and lets
// physics settle them. `table` receives the poses after that.
SettledTwin SettleReconstruction(const core::Image& photo, const twin::Detections& detections,
                                 std::uint64_t seed, twin::TableReconstruction* table);

// Returns the photo (RGB) with the detections in colours.
core::Image DetectionsPicture(const core::Image& photo, const twin::Detections& detections);

// Returns two pictures of equal height side by side.
core::Image SideBySide(const core::Image& left, const core::Image& right);

}  // namespace simwright::bench
