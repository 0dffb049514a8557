#pragma once

#include "nn/diffusion_schedule.h"

namespace simwright::scene {

// Returns the noise schedule of poses in `steps` steps: DDPM of Ho et al. (2020) with linear betas
// from 1e-4 to 0.02, as in Pfaff et al.
inline nn::DiffusionSchedule PoseSchedule(int steps) {
  return nn::DiffusionSchedule::Linear(steps, 1e-4, 0.02);
}

}  // namespace simwright::scene
