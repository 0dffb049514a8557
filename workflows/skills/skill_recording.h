#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/progress.h"
#include "skills/skill_chain.h"

namespace simwright::workflows {

// One moment of a rollout: the state and the commands of the robot.
struct RecordedMoment {
  tasks::WorldState state;      // objects, joints, tool and fingers
  Eigen::VectorXd arm;          // (J) measured joint positions, rad or m
  double leader = 0.0;          // the gripper's first joint position
  Eigen::VectorXd arm_command;  // (J) commanded joint positions
  double leader_command = 0.0;
};

// One decision of a policy.
struct RecordedDecision {
  std::vector<float> observation, next_observation;  // (O)
  std::vector<float> action;                         // (A), in [-1, 1]
  float reward = 0.0f;
  bool done = false;  // the subtask ended with it
};

struct RecordedSubtask {
  skills::StartState start;
  std::vector<RecordedMoment> moments;  // the start, then one after each control step
  std::vector<RecordedDecision> decisions;
  bool success = false;
};

struct ChainRecording {
  std::uint64_t episode = 0;  // the index among the seed's episodes
  std::vector<RecordedSubtask> subtasks;
  bool success = false;  // all subtasks succeeded
};

// Runs the episode of this seed and index exactly as skills::EvaluateChain does, with the same
// outcome, and records all states and commands. Requires at least one link.
ChainRecording RecordEpisode(const std::vector<skills::ChainLink>& links, std::uint64_t seed,
                             std::uint64_t episode);

// The number of episodes that a recording took.
struct RecordingTally {
  int tried = 0, succeeded = 0;  // RecordSuccesses keeps only some successes
};

// A predicate that returns true to keep a successful episode; called from several threads.
using KeepRecording = std::function<bool(const ChainRecording&)>;

// Returns the first `count` of the seed's episodes in which the whole task succeeds and that `keep`
// accepts (no `keep`: all). Throws core::Error if fewer than one in twenty are kept. Advances
// `progress`, if any, by the kept episodes.
std::vector<ChainRecording> RecordSuccesses(const std::vector<skills::ChainLink>& links, int count,
                                            std::uint64_t seed, RecordingTally* tally,
                                            const KeepRecording& keep = {},
                                            core::Progress* progress = nullptr);

}  // namespace simwright::workflows
