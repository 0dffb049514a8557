#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "pipeline/skill_notes.h"
#include "pipeline/skill_replay.h"
#include "pipeline/skill_run.h"

namespace simwright::pipeline {

// Repeats files of `export` with the skills of the run that they are of.
class FileReplay {
 public:
  // `folder`: the run's; empty: where the first file's notes say. It is read with the first file.
  explicit FileReplay(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // A run that is prepared already. Then Trajectories and Demonstrations may be called from several
  // threads.
  FileReplay(const SkillRun& run, const std::vector<RunSkill>& skills);

  // One episode a file, in their order. All throw core::Error as Replay does.
  std::vector<ReplayedEpisode> Trajectories(const std::vector<std::filesystem::path>& files);
  // One episode a demonstration.
  std::vector<ReplayedEpisode> Demonstrations(const std::filesystem::path& file);

  const std::vector<RunSkill>& skills() const { return skills_; }

 private:
  // Throws core::Error unless `notes`, of `where`, are of the run.
  void Require(const SkillNotes& notes, const std::string& where);
  ReplayedEpisode EpisodeOf(const std::string& name, std::vector<bool> successes) const;

  std::filesystem::path folder_;
  std::optional<SkillRun> run_;
  std::vector<RunSkill> skills_, fine_skills_;  // the latter for trajectories
};

}  // namespace simwright::pipeline
