#include "workflows/skills/skill_replay.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/json.h"
#include "core/parallel.h"
#include "workflows/skills/file_replay.h"
#include "workflows/skills/motion_files.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

bool IsDemonstrations(const fs::path& file) {
  return file.extension() == ".hdf5" || file.extension() == ".h5";
}

// Returns the files to replay; those of a folder are sorted by name.
std::vector<fs::path> FilesOf(const ReplayRequest& request) {
  constexpr std::string_view kEndings[] = {".yaml", ".yml", ".json", ".csv", ".hdf5", ".h5"};
  std::vector<fs::path> files;
  for (const fs::path& given : request.files) {
    if (!fs::is_directory(given)) {
      files.push_back(given);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(given)) {
      const std::string ending = entry.path().extension();
      const bool known =
          std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
      if (known && !IsMotionSideFile(entry.path())) inside.push_back(entry.path());
    }
    if (inside.empty()) {
      throw core::Error("has no exported files", given.string(), "see simwright export");
    }
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

}  // namespace

ReplayReport Replay(const ReplayRequest& request, core::Progress* progress) {
  // Trajectories at 1 kHz are large: this many are in memory at a time.
  const auto most = static_cast<size_t>(4 * core::ThreadCount());
  const std::vector<fs::path> files = FilesOf(request);
  progress->Stage("replay", static_cast<int>(files.size()));
  FileReplay run(request.run);
  ReplayReport report;
  for (size_t i = 0; i < files.size();) {
    std::vector<fs::path> together;
    std::vector<ReplayedEpisode> episodes;
    if (IsDemonstrations(files[i])) {
      episodes = run.Demonstrations(files[i++]);
    } else {
      while (i < files.size() && together.size() < most && !IsDemonstrations(files[i])) {
        together.push_back(files[i++]);
      }
      episodes = run.Trajectories(together);
    }
    for (ReplayedEpisode& episode : episodes) {
      report.successes += episode.success;
      report.episodes.push_back(std::move(episode));
    }
    progress->Advance();
  }
  for (const RunSkill& skill : run.skills()) report.subtasks.push_back(skill.name);
  report.interval = rl::WilsonInterval(report.successes, static_cast<int>(report.episodes.size()));
  return report;
}

std::string ReplayTable(const ReplayReport& report) {
  std::string table;
  char line[256];
  for (const ReplayedEpisode& episode : report.episodes) {
    std::snprintf(line, sizeof(line), "%-40.40s %s\n", episode.name.c_str(),
                  episode.success
                      ? "success"
                      : ("failed at " + report.subtasks[episode.successes.size() - 1]).c_str());
    table += line;
  }
  const auto count = static_cast<double>(report.episodes.size());
  std::snprintf(line, sizeof(line), "success: %d of %zu, %.1f %% (95 %%: %.1f to %.1f)\n",
                report.successes, report.episodes.size(), 100.0 * report.successes / count,
                100.0 * report.interval.low, 100.0 * report.interval.high);
  return table + line;
}

std::string ReplayJson(const ReplayReport& report) {
  core::Json text = {{"episodes", report.episodes.size()},
                     {"successes", report.successes},
                     {"low", report.interval.low},
                     {"high", report.interval.high},
                     {"subtasks", report.subtasks}};
  for (const ReplayedEpisode& episode : report.episodes) {
    text["replays"].push_back(
        {{"name", episode.name}, {"success", episode.success}, {"subtasks", episode.successes}});
  }
  return core::JsonText(text);
}

}  // namespace simwright::workflows
