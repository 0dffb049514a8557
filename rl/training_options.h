#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "rl/policy.h"
#include "rl/ppo_options.h"

namespace simwright::rl {

struct TrainingOptions {
  PpoOptions ppo;
  // The stopping criteria of a training: the number of samples; the time (0: unlimited), over all
  // runs; or the lower end of the success rate's 95 % interval reaching `success_target` (0:
  // never): of the examinations, or without an examiner of the last `success_window` episodes.
  std::int64_t max_samples = 1'000'000;
  double max_seconds = 0.0;
  double success_target = 0.0;
  // 200 of 200 successes give a lower end of 0.98, 188 give 0.90.
  int success_window = 200;
  // The iterations between examinations, which begin once this share of the window's episodes
  // succeed; before that, an examination only costs time. Episodes with exploration succeed less
  // often than the mean action. With 0 the first iteration is examined too: the initial policy may
  // already be good.
  int examine_every = 10;
  double examine_from = 0.35;
  // The iterations between checkpoints: about 100k samples, the half minute that a crash costs.
  int checkpoint_every = 25;
  // The checkpoint of another training with the same networks whose policy, critic and normalizers
  // initialize this one; environment, progress and metadata are not taken. Empty: random
  // initialization.
  std::filesystem::path begin_from;
  // The metadata that is written into checkpoint and policy; a training resumes only if it is equal
  // (the task's name and hash).
  Metadata metadata;
  std::string title = "training";  // of the curves

  // Returns false, with the reason, for invalid values.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::rl
