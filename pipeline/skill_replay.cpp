#include "pipeline/skill_replay.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "pipeline/skill_demonstrations.h"
#include "pipeline/skill_export.h"
#include "pipeline/trajectory_replay.h"
#include "robot/trajectory_file.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

bool IsDemonstrations(const fs::path& file) {
  return file.extension() == ".hdf5" || file.extension() == ".h5";
}

bool IsNotes(const fs::path& file) {
  return file.string().ends_with(".notes.json");
}

// The files to replay, those of a folder in order of their names.
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
      if (known && !IsNotes(entry.path())) inside.push_back(entry.path());
    }
    if (inside.empty()) {
      throw core::Error("holds nothing that was exported", given.string(), "see simwright export");
    }
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

robot::JointTrajectory ReadWithNotes(const fs::path& file) {
  robot::JointTrajectory trajectory = robot::ReadTrajectory(file);
  if (file.extension() != ".json") return trajectory;
  const fs::path notes = NotesBeside(file);
  if (!fs::exists(notes)) {
    throw core::Error("its notes are not beside it", file.string(),
                      "keep " + notes.filename().string() + " with it, or export YAML");
  }
  try {
    trajectory.notes =
        json::parse(core::ReadFile(notes, 1 << 24)).get<std::map<std::string, std::string>>();
  } catch (const json::exception&) {
    throw core::Error("holds no notes", notes.string(), "export it anew");
  }
  return trajectory;
}

// The run that the files are of, prepared when the first one says which.
class ReplayRun {
 public:
  explicit ReplayRun(const fs::path& folder) : folder_(folder) {}

  // Throws core::Error unless `notes`, of `where`, are of the run.
  void Require(const SkillNotes& notes, const std::string& where) {
    if (!run_) {
      const fs::path folder = folder_.empty() ? fs::path(notes.run) : folder_;
      if (!fs::exists(folder)) {
        throw core::Error("the run is not there", folder.string(), "say where it is with --run");
      }
      run_ = ReadRun(folder);
      skills_ = PrepareSkills(*run_);
    }
    RequireOfRun(notes, *run_, skills_, where);
  }

  const std::vector<RunSkill>& skills() const { return skills_; }
  // Those for trajectories.
  const std::vector<RunSkill>& fine_skills() {
    if (fine_skills_.empty()) fine_skills_ = PrepareSkills(AtPhysicsRate(*run_));
    return fine_skills_;
  }

 private:
  fs::path folder_;
  std::optional<SkillRun> run_;
  std::vector<RunSkill> skills_, fine_skills_;
};

std::vector<ReplayedEpisode> ReplayDemonstrations(const fs::path& file, ReplayRun* run) {
  const robot::DemonstrationSet set = robot::ReadDemonstrations(file);
  const std::vector<DemonstrationPlan> plans = PlansOf(set, file.string());
  for (const DemonstrationPlan& plan : plans) run->Require(plan.notes, file.string());
  std::vector<ReplayedEpisode> episodes(plans.size());
  core::ParallelFor(static_cast<int>(plans.size()), [&](int i) {
    const auto d = static_cast<size_t>(i);
    episodes[d].name = file.filename().string() + " demo_" + std::to_string(i);
    episodes[d].successes =
        ReplayDemonstration(run->skills(), set.demonstrations[d], plans[d], episodes[d].name);
  });
  return episodes;
}

std::vector<ReplayedEpisode> ReplayTrajectories(const std::vector<fs::path>& files,
                                                ReplayRun* run) {
  std::vector<robot::JointTrajectory> trajectories;
  std::vector<SkillNotes> notes;
  for (const fs::path& file : files) {
    trajectories.push_back(ReadWithNotes(file));
    notes.push_back(NotesFrom(trajectories.back().notes, file.string()));
    run->Require(notes.back(), file.string());
  }
  const std::vector<RunSkill>& skills = run->fine_skills();
  std::vector<ReplayedEpisode> episodes(files.size());
  core::ParallelFor(static_cast<int>(files.size()), [&](int i) {
    const auto f = static_cast<size_t>(i);
    episodes[f].name = files[f].filename().string();
    episodes[f].successes = ReplayTrajectory(skills, trajectories[f], notes[f], files[f].string());
  });
  return episodes;
}

}  // namespace

ReplayReport Replay(const ReplayRequest& request, core::Progress* progress) {
  // Trajectories at 1 kHz are large: so many are held at a time.
  const auto most = static_cast<size_t>(4 * core::ThreadCount());
  const std::vector<fs::path> files = FilesOf(request);
  progress->Stage("replay", static_cast<int>(files.size()));
  ReplayRun run(request.run);
  ReplayReport report;
  for (size_t i = 0; i < files.size();) {
    std::vector<fs::path> together;
    std::vector<ReplayedEpisode> episodes;
    if (IsDemonstrations(files[i])) {
      episodes = ReplayDemonstrations(files[i++], &run);
    } else {
      while (i < files.size() && together.size() < most && !IsDemonstrations(files[i])) {
        together.push_back(files[i++]);
      }
      episodes = ReplayTrajectories(together, &run);
    }
    for (ReplayedEpisode& episode : episodes) {
      episode.success = episode.successes.size() == run.skills().size() && episode.successes.back();
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
  json text = {{"episodes", report.episodes.size()},
               {"successes", report.successes},
               {"low", report.interval.low},
               {"high", report.interval.high},
               {"subtasks", report.subtasks}};
  for (const ReplayedEpisode& episode : report.episodes) {
    text["replays"].push_back(
        {{"name", episode.name}, {"success", episode.success}, {"subtasks", episode.successes}});
  }
  return text.dump(2) + "\n";
}

}  // namespace simwright::pipeline
