#include "workflows/skills/rank_training.h"

#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "skills/skill_environment.h"
#include "skills/skill_evaluation.h"
#include "skills/start_pool.h"
#include "workflows/skills/subtask_training.h"

namespace simwright::workflows {
namespace {

// The part of a list that belongs to this rank.
struct RankShare {
  int first = 0, count = 0;
};

RankShare ShareOfRank(int count, const rl::Communicator& ranks) {
  const auto begin = [&](int rank) {
    return static_cast<int>(static_cast<std::int64_t>(count) * rank / ranks.size());
  };
  return {begin(ranks.rank()), begin(ranks.rank() + 1) - begin(ranks.rank())};
}

// Trains this rank's share; all ranks call it together with equal arguments.
RankTraining TrainShare(const TrainRequest& request, const SkillRun& run, const RunSkill& skill,
                        const std::vector<skills::StartState>& pool, bool resume,
                        core::Progress* progress) {
  rl::Communicator* const ranks = request.ranks;
  skills::SkillEnvironment environment(skill.skill, ShareOfRank(run.environments, *ranks).count,
                                       pool);
  const std::vector<skills::StartState> all =
      ExaminationStarts(*skill.evaluated, pool, request.seed);
  const RankShare share = ShareOfRank(static_cast<int>(all.size()), *ranks);
  const std::vector<skills::StartState> starts(all.begin() + share.first,
                                               all.begin() + share.first + share.count);
  const rl::TrainingOptions options = OptionsFor(request, run, skill);
  RankTraining training;
  training.result = rl::TrainPolicy(
      &environment, options, skill.folder, resume,
      [&](const rl::TrainingRecord& record) {
        RequireValidPhysics(environment, skill.name, record.samples);
        ReportProgress(record, options, progress);
      },
      [&](const rl::Policy& policy) {
        if (starts.empty()) return rl::Examination();
        const skills::SkillEvaluation found = skills::Evaluate(*skill.evaluated, policy, starts);
        return rl::Examination{found.successes, share.count};
      },
      ranks);
  training.failures =
      static_cast<std::int64_t>(ranks->Sum(static_cast<double>(environment.failures())));
  return training;
}

// Formats what rank 0 asks for. A subtask's folder has a name of its own in the run.
std::string OrderText(const RunSkill& skill, const std::vector<skills::StartState>& pool,
                      bool resume) {
  core::Json order = {{"subtask", skill.folder.filename().string()}, {"resume", resume}};
  order["starts"] = core::Json::array();
  for (const skills::StartState& start : pool) order["starts"].push_back(skills::StartText(start));
  return core::JsonText(order);
}

const RunSkill& SkillNamed(const std::vector<RunSkill>& skills, const std::string& folder) {
  for (const RunSkill& skill : skills) {
    if (skill.folder.filename() == folder) return skill;
  }
  throw core::Error("rank 0 has a subtask that this rank does not have", folder,
                    "give all ranks the same tasks");
}

}  // namespace

RankTraining TrainOnAllRanks(const TrainRequest& request, const SkillRun& run,
                             const RunSkill& skill, const std::vector<skills::StartState>& pool,
                             bool resume, core::Progress* progress) {
  if (request.ranks->size() > 1) request.ranks->Broadcast(OrderText(skill, pool, resume));
  return TrainShare(request, run, skill, pool, resume, progress);
}

void DismissRanks(const TrainRequest& request) {
  request.ranks->Broadcast("");
}

void FollowRankZero(const TrainRequest& request, const SkillRun& run,
                    const std::vector<RunSkill>& skills) {
  core::Progress silent;
  for (;;) {
    const std::string text = request.ranks->Broadcast("");
    if (text.empty()) return;
    const core::Json order = core::ParseJson(text, "the order of rank 0");
    const RunSkill& skill = SkillNamed(skills, order["subtask"]);
    std::vector<skills::StartState> pool;
    for (const std::string start : order["starts"]) {
      pool.push_back(skills::ParseStart(start, *skill.skill, "the order of rank 0"));
    }
    TrainShare(request, run, skill, pool, order["resume"], &silent);
  }
}

}  // namespace simwright::workflows
