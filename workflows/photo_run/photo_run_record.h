#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/folder_lock.h"
#include "workflows/photo_run/photo_run.h"

namespace simwright::workflows {

// A stage of a run. Stages are kept in the order of their start.
struct RunStage {
  std::string name;
  double seconds = 0.0;  // total over all runs
  bool done = false;
};

// The run.json of a photo run: its inputs and its progress. Every change is written atomically at
// once.
class PhotoRunRecord {
 public:
  // Starts a run, or resumes the one in request.output if `resume` is set. Throws core::Error for a
  // folder that already exists, that has no run, that another process is using, or whose run was
  // started with other inputs, naming the difference. The bounds of the training (samples, minutes)
  // may change until it is done.
  explicit PhotoRunRecord(const PhotoRunRequest& request);

  bool Done(const std::string& stage) const;
  double SecondsOf(const std::string& stage) const;
  // Adds time to a stage; `done` marks it as finished.
  void Spend(const std::string& stage, double seconds, bool done);
  // Removes the folder if no stage is done.
  void RemoveIfNothingIsDone();

  const std::vector<RunStage>& stages() const { return stages_; }

 private:
  // The name and value of every input that the result depends on, as flags show them.
  using Inputs = std::vector<std::pair<std::string, std::string>>;
  void Read(const std::filesystem::path& file);
  void Write() const;
  void RequireSame(const Inputs& wanted) const;
  static Inputs InputsOf(const PhotoRunRequest& request);

  std::filesystem::path folder_;
  Inputs inputs_;
  std::vector<RunStage> stages_;
  std::optional<core::FolderLock> lock_;
};

}  // namespace simwright::workflows
