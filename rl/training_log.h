#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rl/training_record.h"

namespace simwright::rl {

// A training's record on disk: training.csv, one row an iteration, and an event file for
// TensorBoard beside it with the same numbers.
class TrainingLog {
 public:
  // Begins anew in `folder`; where `last_iteration` is above 0, goes on after that iteration's row:
  // later ones, which the training is about to repeat, are cut off, and so is a row half written.
  // Throws core::Error: not writable, or a training.csv that is none.
  TrainingLog(const std::filesystem::path& folder, std::int64_t last_iteration);

  // Throws core::Error where it cannot be written (a full disk).
  void Append(const TrainingRecord& record);

  // All rows so far.
  const std::vector<TrainingRecord>& records() const { return records_; }

 private:
  std::filesystem::path table_, events_;
  std::vector<TrainingRecord> records_;
};

// The rows of a training.csv whose iterations are not above `last_iteration`. Throws core::Error
// where the columns are others.
std::vector<TrainingRecord> ReadTrainingTable(const std::filesystem::path& path,
                                              std::int64_t last_iteration);

}  // namespace simwright::rl
