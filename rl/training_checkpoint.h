#pragma once

#include <cstdint>
#include <filesystem>

#include "rl/policy.h"
#include "rl/ppo.h"
#include "rl/recent_outcomes.h"

namespace simwright::rl {

// The progress of a training, beside the state of Ppo.
struct TrainingProgress {
  std::int64_t iteration = 0;
  std::int64_t episodes = 0;
  double seconds = 0.0;  // training time over all runs
  double best = -1.0;    // highest success rate of an examination; -1: none yet
  bool learnt = false;   // the last examination reached the target
};

// Writes the complete state of a training into one file: networks, optimizer, normalizers,
// generators, the environment's state, progress, recent outcomes. Writes a temporary file and
// renames it, so that a full disk keeps the previous one. All ranks call it; rank 0 writes the
// file, with the generators, episodes and demonstrations of each. Throws core::Error.
void WriteCheckpoint(const Ppo& ppo, const TrainingProgress& progress, const OutcomeWindow& recent,
                     const Metadata& metadata, const std::filesystem::path& path);

// Restores the state written by WriteCheckpoint: the resumed training is bit-identical to an
// uninterrupted one. Throws core::Error, naming the file, if it is missing, damaged, of another
// version, network or environment, or if one of `metadata` has another value in it; `ppo` is then
// in an unspecified state. Each rank reads the file. Written by another number of ranks, it
// restores all but generators, demonstrations and episodes, which start afresh.
TrainingProgress ReadCheckpoint(const std::filesystem::path& path, const Metadata& metadata,
                                Ppo* ppo, OutcomeWindow* recent);

// Restores networks, optimizer and normalizers only, to fine-tune in another environment or with
// another reward. Throws core::Error as ReadCheckpoint does.
void BeginFromCheckpoint(const std::filesystem::path& path, Ppo* ppo);

}  // namespace simwright::rl
