#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rl/training_record.h"

namespace simwright::rl {

// The log of a training on disk: training.csv, one row per iteration, and a TensorBoard event file
// beside it with the same numbers.
class TrainingLog {
 public:
  // Starts a new log in `folder`; if `last_iteration` is above 0, continues after the row of that
  // iteration: later rows, which the training repeats, and an incomplete row are removed. Throws
  // core::Error if the folder is not writable, or if training.csv has another format.
  TrainingLog(const std::filesystem::path& folder, std::int64_t last_iteration);

  // Throws core::Error if the row cannot be written (a full disk).
  void Append(const TrainingRecord& record);

  // Returns all rows so far.
  const std::vector<TrainingRecord>& records() const { return records_; }

 private:
  std::filesystem::path table_, events_;
  std::vector<TrainingRecord> records_;
};

// Returns the rows of a training.csv up to iteration `last_iteration`. Throws core::Error if the
// columns differ.
std::vector<TrainingRecord> ReadTrainingTable(const std::filesystem::path& path,
                                              std::int64_t last_iteration);

}  // namespace simwright::rl
