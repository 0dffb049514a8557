#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/wilson_interval.h"

namespace simwright::pipeline {

struct ReplayRequest {
  std::vector<std::filesystem::path> files;  // of `export`, or folders of them
  std::filesystem::path run;                 // empty: where the first file's notes say
};

struct ReplayedEpisode {
  std::string name;             // file, and demonstration where it has several
  std::vector<bool> successes;  // by subtask, up to the first that failed
  bool success = false;         // of all
};

struct ReplayReport {
  std::vector<std::string> subtasks;
  std::vector<ReplayedEpisode> episodes;
  int successes = 0;
  rl::Interval interval;  // 95 %
};

// Repeats exported motions and demonstrations in simulation from their files alone. Throws
// core::Error: a file that cannot be read or is none of `export`'s, of another robot or task, of
// assets that have changed; a run that is not there.
ReplayReport Replay(const ReplayRequest& request, core::Progress* progress);

std::string ReplayTable(const ReplayReport& report);
std::string ReplayJson(const ReplayReport& report);

}  // namespace simwright::pipeline
