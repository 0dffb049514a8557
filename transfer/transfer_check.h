#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "transfer/perturbed_twin.h"
#include "transfer/transfer_rate.h"
#include "transfer/transfer_task.h"

namespace simwright::transfer {

constexpr double kHeldShare = 0.9;  // of the perturbed twins in which a motion should succeed

struct TransferRequest {
  std::filesystem::path motion;  // written by `simwright export`
  std::filesystem::path twin;    // a folder written by `simwright twin`
  std::filesystem::path run;     // of the motion; empty: taken from its metadata
  int worlds = 100;
  std::uint64_t seed = 1;
};

// The success of one way to do the task.
struct TransferResult {
  TransferRate rate;           // at the twin's own uncertainty
  double largest_scale = 0.0;  // of the uncertainty at which it succeeds in kHeldShare; -1: in none
};

struct TransferReport {
  std::string task, motion;
  TransferResult replay;                 // the motion alone
  std::optional<TransferResult> policy;  // acting on what it observes; none: the run has no policy
  core::Findings findings;
};

// The ranges of masses and frictions of a training run.
PhysicsRanges PhysicsRangesOf(const workflows::SkillRun& run);

// Returns the twin of `record`, in which `task` starts, with the ranges of its run.
PerturbedTwin PerturbedTwinOf(const TransferTask& task, const workflows::TwinRecord& record,
                              const std::filesystem::path& where);

// Returns the policies of a run's subtasks, in order; empty if one has none yet.
std::vector<rl::Policy> PoliciesOf(const TransferTask& task);

// Measures how often a motion, and the policy that it comes from, succeed in worlds within the
// twin's uncertainty (PerturbedTwin), and up to which scale of its uncertainty. A pure function of
// the files and the seed. Throws core::Error for a file, run or twin that cannot be read or do not
// belong together, and core::Cancelled.
TransferReport CheckTransfer(const TransferRequest& request, core::Progress* progress);

std::string TransferTable(const TransferReport& report);
std::string TransferJson(const TransferReport& report);

}  // namespace simwright::transfer
