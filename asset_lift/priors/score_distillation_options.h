#pragma once

#include <string>

namespace simwright::asset_lift {

struct ScoreDistillationOptions {
  // The bounds between which t is sampled, as shares of the diffusion steps; they move from the
  // first to the second value over `anneal` of the fit. Zero-1-to-3 in threestudio: .4 to .2 and
  // .85 to .5.
  double t_min_first = 0.4, t_min_last = 0.2;
  double t_max_first = 0.85, t_max_last = 0.5;
  double anneal = 0.33;
  double guidance = 3.0;          // classifier-free (Ho and Salimans 2022)
  double elevation_min = -0.17;   // rad; -10 to 80 degrees as in threestudio
  double elevation_max = 1.4;     // rad
  int side = 0;                   // pixels per side of the requested images; 0: the prior's size
  double largest_gradient = 1.0;  // per pixel channel, before the sum: clips outliers

  bool IsValid(std::string* error) const;
};

}  // namespace simwright::asset_lift
