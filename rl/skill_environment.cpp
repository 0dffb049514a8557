#include "rl/skill_environment.h"

#include <cstring>

#include "core/error.h"
#include "core/parallel.h"
#include "rl/observation.h"
#include "rl/scripted_hand.h"
#include "rl/skill_evaluation.h"

namespace simwright::rl {
namespace {

constexpr std::uint64_t kEpisodesOfOne = 1ull << 40;  // more than one environment ever sees

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
                                   std::vector<EpisodeStart> pool)
    : skill_(std::move(skill)), pool_(std::move(pool)) {
  if (count < 1) throw core::Error("a training needs at least one environment");
  observation_size_ = Observer(*skill_, skill_->variants.front()).size();
  action_size_ = ActionSize(*skill_);
  slots_.resize(static_cast<size_t>(count));
  for (Slot& slot : slots_) {
    slot.episode = std::make_unique<Episode>(*skill_);
    slot.actions.reserve(static_cast<size_t>(action_size_ * skill_->options.decisions()));
  }
}

SkillEnvironment::~SkillEnvironment() = default;

// Body(i) for every environment. Threads take the next one when they are done with theirs: where an
// episode ends, its successor has to be planned, which takes as long as ten decisions.
template <typename Body>
void SkillEnvironment::ForEach(const Body& body) {
  core::ParallelFor(size(), [&](int i) { body(static_cast<size_t>(i)); });
}

std::uint64_t SkillEnvironment::EpisodeSeed(size_t slot) const {
  return slot * kEpisodesOfOne + slots_[slot].number;
}

void SkillEnvironment::Begin(size_t index) {
  Slot& slot = slots_[index];
  core::Rng rng = core::StreamRng(seed_, EpisodeSeed(index));
  slot.actions.clear();
  slot.episode->Begin(NextStart(rng));
}

EpisodeStart SkillEnvironment::NextStart(core::Rng& rng) const {
  if (pool_.empty() || core::Uniform(rng) >= skill_->options.pool_share) {
    return DrawStart(*skill_, rng);
  }
  const auto index = core::UniformIndex(rng, static_cast<std::int64_t>(pool_.size()));
  return Varied(*skill_, pool_[static_cast<size_t>(index)], rng);
}

void SkillEnvironment::Reset(std::uint64_t seed, Rows* observations) {
  seed_ = seed;
  observations->resize(size(), observation_size_);
  ForEach([&](size_t i) {
    slots_[i].number = 0;
    slots_[i].failures = 0;
    Begin(i);
    slots_[i].episode->Observe(observations->row(static_cast<Eigen::Index>(i)).data());
  });
}

void SkillEnvironment::StepOne(size_t index, const Rows& actions, StepBatch* batch) {
  Slot& slot = slots_[index];
  const auto row = static_cast<Eigen::Index>(index);
  const float* action = actions.row(row).data();
  slot.actions.insert(slot.actions.end(), action, action + action_size_);
  const Decision decision = slot.episode->Step(action);
  batch->rewards[index] = decision.reward;
  if (decision.terminated && share_of_end_) {
    batch->rewards[index] *= static_cast<float>(share_of_end_(EndOf(*slot.episode)));
  }
  batch->terminated[index] = decision.terminated;
  batch->truncated[index] = decision.truncated;
  batch->success[index] = decision.terminated;  // held, not only reached
  if (decision.failed) {
    ++slot.failures;
    slot.failed = slot.number;
  }
  if (decision.terminated || decision.truncated) {
    slot.episode->Observe(batch->last_observations.row(row).data());
    ++slot.number;
    Begin(index);
  }
  slot.episode->Observe(batch->observations.row(row).data());
}

void SkillEnvironment::Step(const Rows& actions, StepBatch* batch) {
  const auto count = static_cast<size_t>(size());
  batch->observations.resize(size(), observation_size_);
  batch->last_observations.resize(size(), observation_size_);
  batch->rewards.resize(count);
  batch->terminated.resize(count);
  batch->truncated.resize(count);
  batch->success.resize(count);
  ForEach([&](size_t i) { StepOne(i, actions, batch); });
}

bool SkillEnvironment::Demonstrate(Rows* actions) const {
  if (skill_->options.action != ActionSpace::kFocus) return false;
  actions->resize(size(), action_size_);
  for (size_t i = 0; i < slots_.size(); ++i) {
    ScriptedAction(*slots_[i].episode, actions->row(static_cast<Eigen::Index>(i)).data());
  }
  return true;
}

std::string SkillEnvironment::SaveState() const {
  std::string bytes;
  Append(static_cast<std::uint64_t>(slots_.size()), &bytes);
  Append(seed_, &bytes);
  for (const Slot& slot : slots_) {
    Append(slot.number, &bytes);
    Append(slot.failures, &bytes);
    Append(static_cast<std::uint64_t>(slot.actions.size()), &bytes);
    for (const float action : slot.actions) Append(action, &bytes);
  }
  return bytes;
}

void SkillEnvironment::RestoreState(std::string_view state, Rows* observations) {
  if (Take<std::uint64_t>(&state) != slots_.size()) {
    throw core::Error("the checkpoint holds another number of environments", "checkpoint",
                      "resume with as many as before");
  }
  seed_ = Take<std::uint64_t>(&state);
  for (Slot& slot : slots_) {
    slot.number = Take<std::uint64_t>(&state);
    slot.failures = Take<std::int64_t>(&state);
    slot.actions.clear();
    const auto count = Take<std::uint64_t>(&state);
    if (count > state.size() / sizeof(float)) {
      throw core::Error("the environments' state is cut off", "checkpoint");
    }
    for (std::uint64_t i = 0; i < count; ++i) slot.actions.push_back(Take<float>(&state));
  }
  observations->resize(size(), observation_size_);
  ForEach([&](size_t i) {
    const std::vector<float> actions = slots_[i].actions;
    Begin(i);
    for (size_t a = 0; a + static_cast<size_t>(action_size_) <= actions.size();
         a += static_cast<size_t>(action_size_)) {
      slots_[i].episode->Step(&actions[a]);
    }
    slots_[i].actions = actions;
    slots_[i].episode->Observe(observations->row(static_cast<Eigen::Index>(i)).data());
  });
}

std::int64_t SkillEnvironment::failures() const {
  std::int64_t failures = 0;
  for (const Slot& slot : slots_) failures += slot.failures;
  return failures;
}

std::string SkillEnvironment::LastFailure() const {
  std::string text;
  for (size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].failures == 0) continue;
    text = "environment " + std::to_string(i) + ", episode " + std::to_string(slots_[i].failed) +
           ", seed " + std::to_string(seed_);
  }
  return text;
}

}  // namespace simwright::rl
