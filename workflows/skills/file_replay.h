#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "workflows/skills/skill_metadata.h"
#include "workflows/skills/skill_replay.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

// Replays files written by `export` with the skills of the run that they come from.
class FileReplay {
 public:
  // `folder`: the run's; empty: taken from the first file's metadata. The run is read with the
  // first file.
  explicit FileReplay(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // Uses a run that is already prepared. Trajectories and Demonstrations are then thread-safe.
  FileReplay(const SkillRun& run, const std::vector<RunSkill>& skills);

  // Replays one episode per file, in order. All methods throw core::Error as Replay does.
  std::vector<ReplayedEpisode> Trajectories(const std::vector<std::filesystem::path>& files);
  // Replays one episode per demonstration.
  std::vector<ReplayedEpisode> Demonstrations(const std::filesystem::path& file);

  const std::vector<RunSkill>& skills() const { return skills_; }

 private:
  // Throws core::Error unless `metadata`, read from `where`, belong to the run.
  void Require(const SkillMetadata& metadata, const std::string& where);
  ReplayedEpisode EpisodeOf(const std::string& name, std::vector<bool> successes) const;

  std::filesystem::path folder_;
  std::optional<SkillRun> run_;
  std::vector<RunSkill> skills_, fine_skills_;  // fine_skills_: for trajectories
};

}  // namespace simwright::workflows
