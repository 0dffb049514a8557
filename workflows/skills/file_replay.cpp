#include "workflows/skills/file_replay.h"

#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "workflows/skills/motion_files.h"
#include "workflows/skills/skill_demonstrations.h"
#include "workflows/skills/trajectory_replay.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
FileReplay::FileReplay(const SkillRun& run, const std::vector<RunSkill>& skills)
    : run_(run), skills_(skills), fine_skills_(PrepareSkills(AtPhysicsRate(run))) {}

void FileReplay::Require(const SkillMetadata& metadata, const std::string& where) {
  if (!run_) {
    const fs::path folder = folder_.empty() ? fs::path(metadata.run) : folder_;
    if (!fs::exists(folder)) {
      throw core::Error("the run does not exist", folder.string(), "give its folder with --run");
    }
    run_ = ReadRun(folder);
    skills_ = PrepareSkills(*run_);
  }
  RequireMatchingRun(metadata, *run_, skills_, where);
}

ReplayedEpisode FileReplay::EpisodeOf(const std::string& name, std::vector<bool> successes) const {
  ReplayedEpisode episode;
  episode.name = name;
  episode.success = successes.size() == skills_.size() && successes.back();
  episode.successes = std::move(successes);
  return episode;
}

std::vector<ReplayedEpisode> FileReplay::Demonstrations(const fs::path& file) {
  const robot::DemonstrationSet set = robot::ReadDemonstrations(file);
  const std::vector<DemonstrationPlan> plans = PlansOf(set, file.string());
  for (const DemonstrationPlan& plan : plans) Require(plan.metadata, file.string());
  std::vector<ReplayedEpisode> episodes(plans.size());
  core::ParallelFor(static_cast<int>(plans.size()), [&](int i) {
    const auto d = static_cast<size_t>(i);
    const std::string name = file.filename().string() + " demo_" + std::to_string(i);
    episodes[d] =
        EpisodeOf(name, ReplayDemonstration(skills_, set.demonstrations[d], plans[d], name));
  });
  return episodes;
}

std::vector<ReplayedEpisode> FileReplay::Trajectories(const std::vector<fs::path>& files) {
  std::vector<robot::JointTrajectory> trajectories;
  std::vector<SkillMetadata> metadata;
  for (const fs::path& file : files) {
    trajectories.push_back(ReadMotion(file));
    metadata.push_back(MetadataFrom(trajectories.back().metadata, file.string()));
    Require(metadata.back(), file.string());
  }
  if (fine_skills_.empty()) fine_skills_ = PrepareSkills(AtPhysicsRate(*run_));
  std::vector<ReplayedEpisode> episodes(files.size());
  core::ParallelFor(static_cast<int>(files.size()), [&](int i) {
    const auto f = static_cast<size_t>(i);
    episodes[f] =
        EpisodeOf(files[f].filename().string(),
                  ReplayTrajectory(fine_skills_, trajectories[f], metadata[f], files[f].string()));
  });
  return episodes;
}

}  // namespace simwright::workflows
