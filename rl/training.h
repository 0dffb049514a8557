#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "rl/training_options.h"
#include "rl/training_record.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// Files of a training's folder.
constexpr const char* kCheckpointFile = "checkpoint.pt";  // to go on from
constexpr const char* kPolicyFile = "policy.pt";          // policy_file.h
constexpr const char* kCurvesFile = "curves.svg";

enum class TrainingEnd { kSamples, kSeconds, kSuccess };

struct TrainingResult {
  TrainingEnd end = TrainingEnd::kSamples;
  TrainingRecord last;  // the last iteration's
};

using TrainingListener = std::function<void(const TrainingRecord&)>;

// How often a policy's mean action succeeds from the starts that count: without exploration and
// easier starts, which a training's own episodes have. Gives the same for the same policy.
struct Examination {
  int successes = 0, episodes = 0;
};
using Examiner = std::function<Examination(const Policy&)>;

// Trains a policy by PPO into `folder` (created where missing): the log (training_log.h), and every
// so many iterations checkpoint, policy and curves. `resume`: goes on from the folder's checkpoint,
// or begins where there is none; a training that was stopped then ends with the same policy as one
// that never was. `report` is called after each iteration. With `examine` the policy's file holds
// the best that was examined, the last at the end among them; without, the last.
// Throws core::Error: options that are not valid, a folder that holds a training where `resume` is
// not set, a checkpoint of another training, too many samples that are not finite, a full disk; and
// core::Cancelled after Ctrl-C, once the iteration is done and the checkpoint written.
TrainingResult TrainPolicy(VectorEnvironment* environment, const TrainingOptions& options,
                           const std::filesystem::path& folder, bool resume,
                           const TrainingListener& report = {}, const Examiner& examine = {});

}  // namespace simwright::rl
