#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "rl/policy.h"
#include "rl/ppo_options.h"

namespace simwright::rl {

struct TrainingOptions {
  PpoOptions ppo;
  // Where a training ends: after as many samples; after as many seconds (0: never), over all its
  // runs; or when the lower end of the success rate's 95 % interval has reached `success_target`
  // (0: never): of the examinations, or without an examiner of the last `success_window` episodes.
  std::int64_t max_samples = 1'000'000;
  double max_seconds = 0.0;
  double success_target = 0.0;
  // 200 of 200 successes give a lower end of 0.98, 188 one of 0.90.
  int success_window = 200;
  // Iterations between examinations, which begin once this share of the window's episodes succeed:
  // before that, an examination only costs time. Of the episodes that explore 37 % succeeded where
  // the mean action did in 71 % (a cup that was lifted from a photo, by its rim). With 0 the first
  // iteration is examined too: what a training begins with may be good already.
  int examine_every = 10;
  double examine_from = 0.35;
  // Iterations between checkpoints: about 100k samples, half a minute that a crash costs.
  int checkpoint_every = 25;
  // Checkpoint of another training, of the same networks, whose policy, critic and scales this one
  // begins with; its environment, its progress and its facts are its own. Empty: from nothing.
  std::filesystem::path begin_from;
  // Written into checkpoint and policy; a training only goes on where they are the same (the task's
  // name and hash).
  Facts facts;
  std::string title = "training";  // of the curves

  // False, with the reason, for values that no training can have.
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::rl
