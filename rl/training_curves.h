#pragma once

#include <string>
#include <vector>

#include "rl/training_record.h"

namespace simwright::rl {

// Returns a plot (SVG) of a training: success rate with its 95 % interval, and the mean return,
// over samples.
std::string TrainingCurves(const std::string& title, const std::vector<TrainingRecord>& records);

}  // namespace simwright::rl
