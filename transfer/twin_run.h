#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/progress.h"
#include "transfer/motion_choice.h"
#include "transfer/transfer_check.h"
#include "workflows/skills/skill_training.h"

namespace simwright::transfer {

struct TwinRunRequest {
  std::filesystem::path twin;            // a folder written by `simwright twin`
  std::string task;                      // a name or pattern; empty: SurestPicks
  std::optional<Eigen::Vector3d> robot;  // TwinTasksRequest::robot
  double sigmas = 2.0;                   // PlacementRanges
  int worlds = 100;                      // TransferRequest
  // The training: its task file, tasks, output, ranges, seed and `resume` are set by the run.
  workflows::TrainRequest train;
  std::uint64_t seed = 1;
  std::filesystem::path output;
  bool resume = false, force = false;
};

struct TwinRunOutcome {
  std::string task;
  double success = 0.0;  // of the policy, from starts within the ranges of the training
  MotionChoice motion;
  TransferReport transfer;
  std::filesystem::path folder, picture;
  core::Findings findings;
};

// Generates the twin's tasks, trains one of them with the randomization that the twin's uncertainty
// asks for, exports the motion that holds best, and checks its transfer: docs/twin.md lists the
// files. With `resume`, the tasks, their findings and what is trained are kept, and the later
// stages run again. Throws core::Error for a twin without a task, an unknown task, an output that
// exists, and wherever the stages do; and core::Cancelled.
TwinRunOutcome RunTwin(const TwinRunRequest& request, core::Progress* progress);

std::string TwinRunTable(const TwinRunOutcome& outcome);
std::string TwinRunJson(const TwinRunOutcome& outcome);

}  // namespace simwright::transfer
