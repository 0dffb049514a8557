#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rl/policy.h"

namespace simwright::workflows {

enum class PolicyFormat { kOnnx, kTorchScript };

struct PolicyExportRequest {
  std::filesystem::path run;  // a folder written by TrainTask; empty: a shipped policy
  std::string skill;          // the shipped policy (ReadShippedSkill); empty: the run's
  std::string subtask;        // of a run with several: this one; empty: all, into a folder
  PolicyFormat format = PolicyFormat::kOnnx;
  std::filesystem::path output;  // a file; a folder for several subtasks
  bool force = false;            // replaces an existing output
};

// One exported policy.
struct ExportedPolicy {
  std::string name;  // of the subtask or the shipped skill
  std::filesystem::path file;
  int observation_size = 0, action_size = 0;
  rl::Metadata metadata;  // in the file
};

struct PolicyExportReport {
  std::filesystem::path output;
  std::vector<ExportedPolicy> policies;
};

// Writes the actors of a run or of a shipped skill, each with its observation scale and the clamp
// to
// [-1, 1], as models that run without Simwright (rl/onnx_file.h, rl/policy_torch_script.h). A
// file's metadata states `task`, `robot`, `action_space`, `observation_size`, `action_size`,
// `control_rate_hz` and `version`. Throws core::Error if there is no such run, skill or subtask, a
// subtask has no policy, the extension of the file does not match the format, or the output exists.
PolicyExportReport ExportPolicies(const PolicyExportRequest& request);

std::string PolicyExportTable(const PolicyExportReport& report);
std::string PolicyExportJson(const PolicyExportReport& report);

}  // namespace simwright::workflows
