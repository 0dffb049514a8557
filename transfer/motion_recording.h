#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "robot/retiming.h"
#include "transfer/transfer_check.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::transfer {

// Records motions of a task in its twin, by its policies.
class MotionRecorder {
 public:
  // `policies`: one per subtask; they and `task` must outlive this. Half of the motions are made
  // where the objects stand in the twin, the other half where `ranges` displace them.
  MotionRecorder(const TransferTask& task, const std::vector<rl::Policy>& policies,
                 const std::map<std::string, skills::PlacementRange>& ranges);

  // Returns motions of episode `episode` of `seed` that succeed in the twin itself: the fastest one
  // within the limits, and one at the pace of the recording. Empty if the episode fails or no
  // motion of it succeeds.
  std::vector<TransferMotion> Record(std::uint64_t seed, std::uint64_t episode) const;

 private:
  // Returns a motion of `recording`, at most `pace` times as fast; none if it has none within the
  // limits, or that does not succeed in the twin itself.
  std::optional<TransferMotion> MotionAt(double pace, const workflows::ChainRecording& recording,
                                         const std::vector<workflows::RunSkill>& skills,
                                         std::uint64_t seed) const;

  const TransferTask& task_;
  std::vector<workflows::RunSkill> described_, displaced_;
  std::vector<skills::ChainLink> described_links_, displaced_links_;
};

// Returns a motion that is chosen among `count` episodes, and how it fares.
struct ChosenMotion {
  TransferMotion motion;
  int episodes = 0, recorded = 0;  // tried; of them with motions that succeed in the twin itself
  TransferRate rate;               // of the chosen one, in the worlds that it was chosen by
  // The first motion that was recorded where the objects stand in the twin, or else of all.
  TransferMotion first_motion;
  TransferRate first;
};

// Records the motions of `episodes` episodes and returns the one that succeeds in most of `worlds`
// perturbed twins; of equal ones the first. Throws core::Error if none succeeds in the twin itself.
ChosenMotion ChooseMotion(const MotionRecorder& recorder, const TransferTask& task,
                          const PerturbedTwin& twin, int episodes, int worlds, std::uint64_t seed,
                          core::Progress* progress);

}  // namespace simwright::transfer
