#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/folder_lock.h"
#include "pipeline/photo_run.h"

namespace simwright::pipeline {

// A stage of a run, in the order they were begun.
struct RunStage {
  std::string name;
  double seconds = 0.0;  // spent on it, over all runs
  bool done = false;
};

// run.json of a photo's run: what it was begun with, and how far it has come. Every change is
// written at once, whole or not at all.
class PhotoRunRecord {
 public:
  // Begins a run, or takes up the one that is in request.output, where `resume` is set. Throws
  // core::Error: a folder that is there already, that holds no run, in which another process is at
  // work, or whose run was begun with other inputs, naming what differs. The bounds of the training
  // (samples, minutes) may change until it is done.
  explicit PhotoRunRecord(const PhotoRunRequest& request);

  bool Done(const std::string& stage) const;
  double SecondsOf(const std::string& stage) const;
  // Adds time to a stage; `done`: it is over with it.
  void Spend(const std::string& stage, double seconds, bool done);
  // For a run that has nothing to keep: removes the folder.
  void RemoveIfNothingIsDone();

  const std::vector<RunStage>& stages() const { return stages_; }

 private:
  // Name and value of everything that the result depends on, as flags show them.
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

}  // namespace simwright::pipeline
