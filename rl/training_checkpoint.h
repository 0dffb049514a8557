#pragma once

#include <cstdint>
#include <filesystem>

#include "rl/policy.h"
#include "rl/ppo.h"
#include "rl/recent_outcomes.h"

namespace simwright::rl {

// How far a training has come, beside what Ppo holds.
struct TrainingProgress {
  std::int64_t iteration = 0;
  std::int64_t episodes = 0;
  double seconds = 0.0;  // spent training, over all runs
  double best = -1.0;    // highest success rate that an examination has seen; -1: none yet
  bool learnt = false;   // the last examination has reached the target
};

// Writes all that the rest of a training depends on into one file: networks, optimiser,
// normalisers, generators, the environment's state, progress, recent outcomes. Beside and renamed
// in, so that a full disk keeps the one before. Throws core::Error.
void WriteCheckpoint(const Ppo& ppo, const TrainingProgress& progress, const RecentOutcomes& recent,
                     const Facts& facts, const std::filesystem::path& path);

// Goes on where WriteCheckpoint was: the training is the same, bit for bit, as if it had never
// stopped. Throws core::Error, naming the file: missing, damaged, of another version, of another
// network or environment, or where one of `facts` has another value there; `ppo` is then of no use.
TrainingProgress ReadCheckpoint(const std::filesystem::path& path, const Facts& facts, Ppo* ppo,
                                RecentOutcomes* recent);

// Takes networks, optimiser and scales from there, and nothing else: another environment, or
// another reward, is learnt from what is known. Throws core::Error as ReadCheckpoint does.
void BeginFromCheckpoint(const std::filesystem::path& path, Ppo* ppo);

}  // namespace simwright::rl
