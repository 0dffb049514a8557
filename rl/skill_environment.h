#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rl/episode.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// N episodes of a skill side by side, a world each. Up to core::ThreadCount() threads take them in
// turn.
class SkillEnvironment : public VectorEnvironment {
 public:
  // `pool`: starts that a share of the episodes begin from instead of drawing their own; none where
  // it is empty. Throws core::Error for count < 1.
  SkillEnvironment(std::shared_ptr<const Skill> skill, int count,
                   std::vector<EpisodeStart> pool = {});
  ~SkillEnvironment() override;

  int size() const override { return static_cast<int>(slots_.size()); }
  int observation_size() const override { return observation_size_; }
  int action_size() const override { return action_size_; }
  // What a success that ends an episode is paid, as a share of what it is paid without: `share` of
  // where it has ended (EndOf), in [0, 1]. Called from several threads. Before the first Reset.
  void PayEnds(std::function<double(const EpisodeStart&)> share) {
    share_of_end_ = std::move(share);
  }
  void Reset(std::uint64_t seed, Rows* observations) override;
  void Step(const Rows& actions, StepBatch* batch) override;
  bool Demonstrate(Rows* actions) const override;  // ScriptedAction
  std::string SaveState() const override;
  void RestoreState(std::string_view state, Rows* observations) override;

  // Decisions after which the physics gave no numbers any more; the episode then ends.
  std::int64_t failures() const;
  // What repeats the last of them: "environment 3, episode 17, seed 5"; empty without any.
  std::string LastFailure() const;
  const Skill& skill() const { return *skill_; }

 private:
  // One environment. Its state is the number of its episode and what was done in it so far: both
  // repeat it bit for bit.
  struct Slot {
    std::unique_ptr<Episode> episode;
    std::uint64_t number = 0;
    std::vector<float> actions;
    std::int64_t failures = 0;
    std::uint64_t failed = 0;  // number of the episode
  };
  std::uint64_t EpisodeSeed(size_t slot) const;
  void Begin(size_t slot);
  void StepOne(size_t slot, const Rows& actions, StepBatch* batch);
  template <typename Body>
  void ForEach(const Body& body);

  EpisodeStart NextStart(core::Rng& rng) const;

  std::shared_ptr<const Skill> skill_;
  std::vector<EpisodeStart> pool_;
  std::function<double(const EpisodeStart&)> share_of_end_;
  std::vector<Slot> slots_;
  int observation_size_ = 0, action_size_ = 0;
  std::uint64_t seed_ = 0;
};

}  // namespace simwright::rl
