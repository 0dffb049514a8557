#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "rl/training_options.h"
#include "rl/training_record.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

class Communicator;

// The files in a training's folder.
constexpr const char* kCheckpointFile = "checkpoint.pt";  // to resume from
constexpr const char* kPolicyFile = "policy.pt";          // policy_file.h
constexpr const char* kCurvesFile = "curves.svg";

enum class TrainingEnd { kSamples, kSeconds, kSuccess };

struct TrainingResult {
  TrainingEnd end = TrainingEnd::kSamples;
  TrainingRecord last;  // of the last iteration
};

using TrainingListener = std::function<void(const TrainingRecord&)>;

// The success rate of a policy's mean action from the start states of the evaluation: without the
// exploration and the easier start states of training episodes. Deterministic for a policy.
struct Examination {
  int successes = 0, episodes = 0;
};
using Examiner = std::function<Examination(const Policy&)>;

// Trains a policy by PPO in `folder` (created if missing): writes the log (training_log.h), and at
// intervals checkpoint, policy and curves. `resume`: resumes from the folder's checkpoint, or
// starts if there is none; a resumed training ends with the same policy as an uninterrupted one.
// Calls `report` after each iteration. With `examine` the policy file holds the best examined
// policy, including the last; without it, the last.
// `ranks`, if given, train together: all call this at once, each with its own environment, and each
// examines its share of the episodes; rank 0 alone reads and writes the folder, except that each
// reads the checkpoint. All end with the same policy.
// Throws core::Error for invalid options, a folder that holds a training if `resume` is not set, a
// checkpoint of another training, too many non-finite samples, or a full disk; and core::Cancelled
// after Ctrl-C, once the iteration is complete and the checkpoint is written.
TrainingResult TrainPolicy(VectorEnvironment* environment, const TrainingOptions& options,
                           const std::filesystem::path& folder, bool resume,
                           const TrainingListener& report = {}, const Examiner& examine = {},
                           Communicator* ranks = nullptr);

}  // namespace simwright::rl
