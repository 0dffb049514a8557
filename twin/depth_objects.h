#pragma once

#include <vector>

#include "core/float_image.h"
#include "twin/object_detector.h"
#include "twin/table_depth.h"

namespace simwright::twin {

// Finds the objects on a table by the depth of the photo's pixels: what stands out of the plane by
// 8 mm or more (three deviations of a noisy plane, if that is more) within the hull of the table,
// grown down to 3 mm, in pieces between which neither the picture nor the depth connects. The
// largest first, with the confidence 1. `depth`: m along the optical axis, of the photo's size.
std::vector<Detection> ObjectsAbovePlane(const core::FloatImage& depth, const DepthPlane& plane);

}  // namespace simwright::twin
