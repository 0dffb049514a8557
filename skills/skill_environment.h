#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rl/vector_environment.h"
#include "skills/episode_start.h"

namespace simwright::skills {

class Episode;

// N parallel episodes of a skill, one world each, distributed over up to core::ThreadCount()
// threads.
class SkillEnvironment : public rl::VectorEnvironment {
 public:
  // `pool`: start states for a share of the episodes; if empty, all start states are sampled.
  // Throws core::Error for count < 1.
  SkillEnvironment(std::shared_ptr<const Skill> skill, int count,
                   std::vector<StartState> pool = {});
  ~SkillEnvironment() override;

  int size() const override { return static_cast<int>(instances_.size()); }
  int observation_size() const override { return observation_size_; }
  int action_size() const override { return action_size_; }
  // Scales the reward of a success that ends an episode by `share` of the end state (EndOf), in [0,
  // 1]. Called from several threads. Set it before the first Reset.
  void ScaleTerminalRewards(std::function<double(const StartState&)> share) {
    share_of_end_ = std::move(share);
  }
  // Calls `listener` with the index of each episode that ends, before the next one begins. Called
  // from several threads; may be empty.
  void SetEndListener(std::function<void(int, const Episode&)> listener) {
    at_end_ = std::move(listener);
  }
  void Reset(std::uint64_t seed, rl::Rows* observations) override;
  void Step(const rl::Rows& actions, rl::StepBatch* batch) override;
  bool Demonstrate(rl::Rows* actions) const override;  // ExpertAction
  std::string SaveState() const override;
  void RestoreState(std::string_view state, rl::Rows* observations) override;

  // Returns which episodes the last Step ended because of an action that was not finite (N flags),
  // and because of non-finite physics.
  const std::vector<std::uint8_t>& invalid_actions() const { return invalid_actions_; }
  const std::vector<std::uint8_t>& failed_physics() const { return failed_physics_; }
  // Returns the number of decisions with non-finite physics or actions; they end their episode.
  std::int64_t failures() const;
  // Returns the data that reproduce the last failure: "environment 3, episode 17, seed 5"; empty
  // without any.
  std::string LastFailure() const;
  const Skill& skill() const { return *skill_; }
  // Returns the current episode of an environment. Valid until the environment is destroyed.
  const Episode& episode(int index) const {
    return *instances_[static_cast<size_t>(index)].episode;
  }
  // Returns a number that no other episode since Reset has, in any environment.
  std::uint64_t episode_seed(int index) const { return EpisodeSeed(static_cast<size_t>(index)); }

 private:
  // One environment. The number of its episode and the actions so far reproduce its state bit for
  // bit.
  struct Instance {
    std::unique_ptr<Episode> episode;
    std::uint64_t number = 0;
    std::vector<float> actions;
    std::int64_t failures = 0;
    std::uint64_t failed = 0;  // number of the episode
  };
  std::uint64_t EpisodeSeed(size_t index) const;
  void Begin(size_t index);
  void StepOne(size_t index, const rl::Rows& actions, rl::StepBatch* batch);
  template <typename Body>
  void ForEach(const Body& body);

  StartState NextStart(core::Rng& rng) const;

  std::shared_ptr<const Skill> skill_;
  std::vector<StartState> pool_;
  std::function<double(const StartState&)> share_of_end_;
  std::function<void(int, const Episode&)> at_end_;
  std::vector<Instance> instances_;
  std::vector<std::uint8_t> invalid_actions_, failed_physics_;  // (N)
  int observation_size_ = 0, action_size_ = 0;
  std::uint64_t seed_ = 0;
};

}  // namespace simwright::skills
