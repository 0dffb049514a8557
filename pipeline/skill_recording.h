#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/progress.h"
#include "rl/chain.h"

namespace simwright::pipeline {

// One moment of a rollout: where everything was, and what the robot was told.
struct RecordedMoment {
  tasks::SceneState state;      // things, joints, tool and fingers
  Eigen::VectorXd arm;          // (J) rad or m, where the joints were
  double leader = 0.0;          // the same of the gripper's first joint
  Eigen::VectorXd arm_command;  // (J) where they were sent
  double leader_command = 0.0;
};

// One decision of a policy.
struct RecordedDecision {
  std::vector<float> observation, next_observation;  // (O)
  std::vector<float> action;                         // (A), in [-1, 1]
  float reward = 0.0f;
  bool done = false;  // the subtask was over with it
};

struct RecordedSubtask {
  rl::EpisodeStart start;
  std::vector<RecordedMoment> moments;  // at the start, then after each control step
  std::vector<RecordedDecision> decisions;
  bool success = false;
};

struct ChainRecording {
  std::uint64_t episode = 0;  // its number among those of its seed
  std::vector<RecordedSubtask> subtasks;
  bool success = false;  // of all of them
};

// Runs an episode as rl::EvaluateChain runs that of the same seed and number, with the same
// outcome, and keeps all that was seen and sent. Requires a link.
ChainRecording RecordEpisode(const std::vector<rl::ChainLink>& links, std::uint64_t seed,
                             std::uint64_t episode);

// How many episodes it took to get those that were asked for.
struct RecordingTally {
  int tried = 0, succeeded = 0;  // as many as RecordSuccesses gives are kept of the latter
};

// Whether an episode that succeeded is kept; called from several threads.
using KeepRecording = std::function<bool(const ChainRecording&)>;

// The first `count` of the seed's episodes in which the whole task succeeds and which `keep` keeps
// (none: all). Throws core::Error where they are fewer than one in twenty. Advances `progress`, if
// any, by those that are kept.
std::vector<ChainRecording> RecordSuccesses(const std::vector<rl::ChainLink>& links, int count,
                                            std::uint64_t seed, RecordingTally* tally,
                                            const KeepRecording& keep = {},
                                            core::Progress* progress = nullptr);

}  // namespace simwright::pipeline
