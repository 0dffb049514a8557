#include "skills/skill_environment.h"

#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "skills/episode.h"
#include "skills/observation.h"
#include "skills/scripted_expert.h"
#include "skills/skill_evaluation.h"

namespace simwright::skills {
namespace {

constexpr std::uint64_t kEpisodesOfOne = 1ull << 40;  // more than any environment runs

template <typename Number>
void Append(const Number& number, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&number), sizeof(number));
}

template <typename Number>
Number Take(std::string_view* bytes) {
  if (bytes->size() < sizeof(Number)) {
    throw core::Error("the environments' state is cut off", "checkpoint");
  }
  Number number;
  std::memcpy(&number, bytes->data(), sizeof(number));
  bytes->remove_prefix(sizeof(number));
  return number;
}

}  // namespace

SkillEnvironment::SkillEnvironment(std::shared_ptr<const Skill> skill, int count,
                                   std::vector<StartState> pool)
    : skill_(std::move(skill)), pool_(std::move(pool)) {
  if (count < 1) throw core::Error("a training needs at least one environment");
  observation_size_ = Observer(*skill_, skill_->variants.front()).size();
  action_size_ = ActionSize(*skill_);
  instances_.resize(static_cast<size_t>(count));
  for (Instance& instance : instances_) {
    instance.episode = std::make_unique<Episode>(*skill_);
    instance.actions.reserve(static_cast<size_t>(action_size_ * skill_->options.decisions()));
  }
}

SkillEnvironment::~SkillEnvironment() = default;

// Calls body(i) for every environment. Threads take the next one as soon as they are done: after an
// episode's end the next one is planned, which takes as long as ten decisions.
template <typename Body>
void SkillEnvironment::ForEach(const Body& body) {
  core::ParallelFor(size(), [&](int i) { body(static_cast<size_t>(i)); });
}

std::uint64_t SkillEnvironment::EpisodeSeed(size_t index) const {
  return index * kEpisodesOfOne + instances_[index].number;
}

void SkillEnvironment::Begin(size_t index) {
  Instance& instance = instances_[index];
  core::Rng rng = core::StreamRng(seed_, EpisodeSeed(index));
  instance.actions.clear();
  instance.episode->Begin(NextStart(rng));
}

StartState SkillEnvironment::NextStart(core::Rng& rng) const {
  if (pool_.empty() || core::Uniform(rng) >= skill_->options.pool_share) {
    return SampleStart(*skill_, rng);
  }
  const auto index = core::UniformIndex(rng, static_cast<std::int64_t>(pool_.size()));
  return PlannedFrom(*skill_, pool_[static_cast<size_t>(index)], rng);
}

void SkillEnvironment::Reset(std::uint64_t seed, rl::Rows* observations) {
  seed_ = seed;
  observations->resize(size(), observation_size_);
  ForEach([&](size_t i) {
    instances_[i].number = 0;
    instances_[i].failures = 0;
    Begin(i);
    instances_[i].episode->Observe(observations->row(static_cast<Eigen::Index>(i)).data());
  });
}

void SkillEnvironment::StepOne(size_t index, const rl::Rows& actions, rl::StepBatch* batch) {
  Instance& instance = instances_[index];
  const auto row = static_cast<Eigen::Index>(index);
  const float* action = actions.row(row).data();
  instance.actions.insert(instance.actions.end(), action, action + action_size_);
  const Decision decision = instance.episode->Step(action);
  batch->rewards[index] = decision.reward;
  if (decision.terminated && share_of_end_) {
    batch->rewards[index] *= static_cast<float>(share_of_end_(EndOf(*instance.episode)));
  }
  batch->terminated[index] = decision.terminated;
  batch->truncated[index] = decision.truncated;
  batch->success[index] = decision.terminated;  // held, not only reached
  invalid_actions_[index] = decision.invalid_action;
  failed_physics_[index] = decision.failed && !decision.invalid_action;
  if (decision.failed) {
    ++instance.failures;
    instance.failed = instance.number;
  }
  if (decision.terminated || decision.truncated) {
    instance.episode->Observe(batch->last_observations.row(row).data());
    if (at_end_) at_end_(static_cast<int>(index), *instance.episode);
    ++instance.number;
    Begin(index);
  }
  instance.episode->Observe(batch->observations.row(row).data());
}

void SkillEnvironment::Step(const rl::Rows& actions, rl::StepBatch* batch) {
  const auto count = static_cast<size_t>(size());
  batch->observations.resize(size(), observation_size_);
  batch->last_observations.resize(size(), observation_size_);
  batch->rewards.resize(count);
  batch->terminated.resize(count);
  batch->truncated.resize(count);
  batch->success.resize(count);
  invalid_actions_.resize(count);
  failed_physics_.resize(count);
  ForEach([&](size_t i) { StepOne(i, actions, batch); });
}

bool SkillEnvironment::Demonstrate(rl::Rows* actions) const {
  if (skill_->options.action != ActionSpace::kTargetFrame) return false;
  actions->resize(size(), action_size_);
  for (size_t i = 0; i < instances_.size(); ++i) {
    ExpertAction(*instances_[i].episode, actions->row(static_cast<Eigen::Index>(i)).data());
  }
  return true;
}

std::string SkillEnvironment::SaveState() const {
  std::string bytes;
  Append(static_cast<std::uint64_t>(instances_.size()), &bytes);
  Append(seed_, &bytes);
  for (const Instance& instance : instances_) {
    Append(instance.number, &bytes);
    Append(instance.failures, &bytes);
    Append(static_cast<std::uint64_t>(instance.actions.size()), &bytes);
    for (const float action : instance.actions) Append(action, &bytes);
  }
  return bytes;
}

void SkillEnvironment::RestoreState(std::string_view state, rl::Rows* observations) {
  if (Take<std::uint64_t>(&state) != instances_.size()) {
    throw core::Error("the checkpoint holds another number of environments", "checkpoint",
                      "resume with as many as before");
  }
  seed_ = Take<std::uint64_t>(&state);
  for (Instance& instance : instances_) {
    instance.number = Take<std::uint64_t>(&state);
    instance.failures = Take<std::int64_t>(&state);
    instance.actions.clear();
    const auto count = Take<std::uint64_t>(&state);
    if (count > state.size() / sizeof(float)) {
      throw core::Error("the environments' state is cut off", "checkpoint");
    }
    for (std::uint64_t i = 0; i < count; ++i) instance.actions.push_back(Take<float>(&state));
  }
  observations->resize(size(), observation_size_);
  ForEach([&](size_t i) {
    const std::vector<float> actions = instances_[i].actions;
    Begin(i);
    for (size_t a = 0; a + static_cast<size_t>(action_size_) <= actions.size();
         a += static_cast<size_t>(action_size_)) {
      instances_[i].episode->Step(&actions[a]);
    }
    instances_[i].actions = actions;
    instances_[i].episode->Observe(observations->row(static_cast<Eigen::Index>(i)).data());
  });
}

std::int64_t SkillEnvironment::failures() const {
  std::int64_t failures = 0;
  for (const Instance& instance : instances_) failures += instance.failures;
  return failures;
}

std::string SkillEnvironment::LastFailure() const {
  std::string text;
  for (size_t i = 0; i < instances_.size(); ++i) {
    if (instances_[i].failures == 0) continue;
    text = "environment " + std::to_string(i) + ", episode " +
           std::to_string(instances_[i].failed) + ", seed " + std::to_string(seed_);
  }
  return text;
}

}  // namespace simwright::skills
