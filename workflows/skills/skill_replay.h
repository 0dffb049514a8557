#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/wilson_interval.h"

namespace simwright::workflows {

struct ReplayRequest {
  std::vector<std::filesystem::path> files;  // written by `export`, or folders of them
  std::filesystem::path run;                 // empty: taken from the first file's metadata
};

struct ReplayedEpisode {
  std::string name;             // the file, and the demonstration if it has several
  std::vector<bool> successes;  // by subtask, up to the first failed one
  bool success = false;         // all subtasks succeeded
};

struct ReplayReport {
  std::vector<std::string> subtasks;
  std::vector<ReplayedEpisode> episodes;
  int successes = 0;
  rl::Interval interval;  // 95 %
};

// Replays exported motions and demonstrations in simulation from their files alone. Throws
// core::Error for a file that cannot be read, was not written by `export`, or belongs to another
// robot or task or to assets that have changed, and for a missing run.
ReplayReport Replay(const ReplayRequest& request, core::Progress* progress);

std::string ReplayTable(const ReplayReport& report);
std::string ReplayJson(const ReplayReport& report);

}  // namespace simwright::workflows
