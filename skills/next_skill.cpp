#include "skills/next_skill.h"

#include "skills/episode.h"
#include "skills/observation.h"

namespace simwright::skills {
namespace {

// Writes the first observation from `start` into `row`. (1 x O)
void ObserveFrom(const StartState& start, Episode* episode, float* row) {
  episode->Begin(start);
  episode->Observe(row);
}

rl::InitiationSet SetOf(const Skill& skill, const std::vector<EvaluatedEpisode>& tried) {
  rl::Rows observations(static_cast<Eigen::Index>(tried.size()),
                        Observer(skill, skill.variants.front()).size());
  std::vector<bool> succeeded;
  Episode episode(skill);
  for (size_t i = 0; i < tried.size(); ++i) {
    ObserveFrom(tried[i].start, &episode, observations.row(static_cast<Eigen::Index>(i)).data());
    succeeded.push_back(tried[i].success);
  }
  return rl::InitiationSet(observations, succeeded);
}

}  // namespace

NextSkill::NextSkill(std::shared_ptr<const Skill> skill, const std::vector<EvaluatedEpisode>& tried)
    : skill_(std::move(skill)), set_(SetOf(*skill_, tried)) {}

double NextSkill::SuccessProbability(const StartState& end) const {
  core::Rng rng = core::StreamRng(0, 0);  // deterministic plans for the same end state
  Episode episode(*skill_);
  std::vector<float> observation(static_cast<size_t>(set_.size()));
  ObserveFrom(PlannedFrom(*skill_, end, rng, Resampling::kNothing), &episode, observation.data());
  return set_.SuccessProbability(observation.data());
}

}  // namespace simwright::skills
