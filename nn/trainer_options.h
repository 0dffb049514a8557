#pragma once

#include <string>

namespace simwright::nn {

// Free of libtorch, so that whoever passes it on is too.
struct TrainerOptions {
  int steps = 1000;
  double learning_rate = 1e-3;  // at the top of the warm-up; then a cosine down to a twentieth
  double warm_share = 0.03;     // of the steps
  double weight_decay = 0.01;   // AdamW (Loshchilov and Hutter 2019)
  double ema_decay = 0.998;     // of the weights that are kept
  double largest_norm = 1.0;    // of the gradient, over all parameters
  // Steps between states written to disk: what a run that was stopped goes on from.
  int save_every = 250;
  bool resume = false;  // go on from the state that an earlier run left

  // False, with the reason, for values that no training can have.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::nn
