#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/progress.h"
#include "transfer/motion_recording.h"

namespace simwright::transfer {

struct MotionChoiceRequest {
  std::filesystem::path run;     // a folder written by `simwright train`
  std::filesystem::path twin;    // of the run's task
  std::filesystem::path output;  // YAML, JSON or CSV, by its extension
  int episodes = 16;             // whose motions are compared
  int worlds = 24;               // perturbed twins in which they are
  double sigmas = 2.0;           // objects of half of the episodes are displaced within these
  std::uint64_t seed = 1;
};

struct MotionChoice {
  std::filesystem::path file;
  int episodes = 0, recorded = 0;  // ChosenMotion
  TransferRate rate, first;
  double seconds = 0.0;  // of the motion
};

// Writes, of the motions of several episodes in the twin, the one that succeeds in most of the
// perturbed twins. Throws core::Error as ChooseMotion does, for a run without a policy, and for a
// run or a twin that cannot be read or do not belong together.
MotionChoice ExportChosenMotion(const MotionChoiceRequest& request, core::Progress* progress);

std::string MotionChoiceTable(const MotionChoice& choice);
std::string MotionChoiceJson(const MotionChoice& choice);

}  // namespace simwright::transfer
