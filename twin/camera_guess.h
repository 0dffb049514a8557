#pragma once

#include <vector>

#include "library_fit/library_prior.h"
#include "twin/observed_object.h"
#include "twin/table_camera.h"

namespace simwright::twin {

// Improves a guess of the camera by the objects that a photo of `width` x `height` pixels shows.
// The library prior tells from which elevation each is seen: with them agrees the elevation of the
// optical axis, by the sum of absolute errors over the expected ones; and how large each is: the
// height of the camera is the median of those at which they have these sizes. What the guess knows
// (errors of 0) stays. kinds[k]: the only kinds considered for object k; empty, or shorter: all.
TableCameraGuess GuessByObjects(const std::vector<ObservedObject>& objects,
                                const std::vector<std::vector<int>>& kinds,
                                const library_fit::LibraryPrior& prior, int width, int height,
                                const TableCameraGuess& guess);

}  // namespace simwright::twin
