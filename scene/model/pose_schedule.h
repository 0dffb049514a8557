#pragma once

#include "nn/diffusion_schedule.h"

namespace simwright::scene {

// How poses turn to noise in `steps` steps: DDPM's of Ho et al. (2020), betas that rise evenly from
// 1e-4 to 0.02, as Pfaff et al. have it.
inline nn::DiffusionSchedule PoseSchedule(int steps) {
  return nn::DiffusionSchedule::Linear(steps, 1e-4, 0.02);
}

}  // namespace simwright::scene
