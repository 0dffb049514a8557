#pragma once

#include <string>

namespace simwright::nn {

// The kernels that update the parameters: one after the other per parameter, or fused over all of
// them (libtorch 2.4 and later). kAutomatic: fused on a GPU where libtorch has them.
enum class UpdateKernels { kAutomatic, kSeparate, kFused };

// The training options. This header does not depend on libtorch, so its users need not either.
struct TrainerOptions {
  int steps = 1000;
  double learning_rate = 1e-3;  // peak after warm-up; then a cosine decay to a twentieth
  double warm_share = 0.03;     // share of the steps that are warm-up
  double weight_decay = 0.01;   // AdamW (Loshchilov and Hutter 2019)
  double ema_decay = 0.998;     // of the averaged weights
  double largest_norm = 1.0;    // gradient clipping: largest norm over all parameters
  // Steps between saved states, from which a stopped run resumes.
  int save_every = 250;
  UpdateKernels kernels = UpdateKernels::kAutomatic;
  bool resume = false;  // resume from the state of an earlier run

  // Returns false, with the reason, for invalid values.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::nn
