#pragma once

#include <cstdint>

#include "capture/capture.h"
#include "capture/feature_tracks.h"
#include "capture/structure_from_motion.h"

namespace simwright::capture {

struct TableCaptureOptions {
  FeatureTrackOptions features;
  StructureOptions structure;
  CaptureOptions capture;  // its print_scale is unused
  std::uint64_t seed = 1;
};

// Finds the cameras of photos of an object on a table without a mat (structure from motion), and
// segments the object by all views together: the table as the other photos show it, and points
// above it, give first masks, and their hull limits the second ones. The result is in a frame of
// arbitrary scale (about 1 between cameras and object) in which the object stands on z = 0. Photos
// that cannot be placed are left out with a finding, and those whose mask contradicts the others'.
// Throws core::Error if fewer than four photos or under half of them can be placed, naming the
// others; if nothing stands on the table; or if the masks agree in less than half of the photos;
// core::Cancelled.
Capture CaptureOnTable(const CaptureSource& source, const TableCaptureOptions& options,
                       core::Progress* progress);

// Scales a capture of arbitrary scale about the point on which the object stands.
void ScaleCapture(double factor, Capture* capture);

}  // namespace simwright::capture
