#pragma once

#include "core/image.h"
#include "twin/object_detector.h"

namespace simwright::twin {

// Returns the detection that a mask (1 channel, the photo's size) states: the confidence is 1, the
// box that of the pixels from 128 on, empty if there is none.
Detection DetectionOfMask(core::Image mask);

}  // namespace simwright::twin
