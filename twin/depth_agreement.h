#pragma once

#include "core/finding.h"
#include "core/float_image.h"
#include "twin/table_reconstruction.h"

namespace simwright::twin {

// Compares the fits of a reconstruction with the measured depth (m, of the photo's size): a finding
// "twin-depth-disagrees" for each object whose distance, the median over the pixels that its render
// and its detection share, is off by more than 10 %. Objects without such a pixel have none.
core::Findings CompareWithDepth(const TableReconstruction& table, const Detections& detections,
                                const core::FloatImage& depth);

}  // namespace simwright::twin
