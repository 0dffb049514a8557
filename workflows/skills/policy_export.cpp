#include "workflows/skills/policy_export.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "rl/onnx_file.h"
#include "rl/policy_file.h"
#include "rl/policy_torch_script.h"
#include "rl/training.h"
#include "workflows/priors/models_folder.h"
#include "workflows/skills/shipped_skills.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr char kProgramVersion[] = SIMWRIGHT_VERSION;

// A policy to export, and what its file states about it.
struct PolicySource {
  std::string name;  // of the subtask or the shipped skill
  std::string robot;
  skills::ActionSpace action = skills::ActionSpace::kTargetFrame;
  rl::Policy policy;
};

std::vector<PolicySource> SourcesOfRun(const PolicyExportRequest& request) {
  const SkillRun run = ReadRun(request.run);
  std::vector<PolicySource> sources;
  std::string names;
  int number = 0;
  for (const tasks::Subtask& subtask : run.set.tasks.front().subtasks) {
    ++number;
    names += (names.empty() ? "" : ", ") + subtask.name;
    if (!request.subtask.empty() && subtask.name != request.subtask) continue;
    const fs::path file = SkillFolder(run, number, subtask.name) / rl::kPolicyFile;
    if (!fs::exists(file)) {
      throw core::Error("the subtask '" + subtask.name + "' has no policy yet", file.string(),
                        "continue with `simwright train ... --resume`");
    }
    sources.push_back({subtask.name, run.robot, run.options.action, rl::ReadPolicy(file)});
  }
  if (sources.empty()) {
    throw core::Error("there is no subtask '" + request.subtask + "'", request.run.string(),
                      "it has " + names);
  }
  return sources;
}

std::vector<PolicySource> SourcesOf(const PolicyExportRequest& request) {
  if (request.skill.empty()) return SourcesOfRun(request);
  const ShippedSkill skill = ReadShippedSkill(ModelsFolder(), request.skill);
  return {{skill.cell.name, skill.cell.robot, skill.action, rl::ReadPolicy(skill.file)}};
}

std::string Extension(PolicyFormat format) {
  return format == PolicyFormat::kOnnx ? ".onnx" : ".pt";
}

rl::Metadata PolicyMetadata(const PolicySource& source) {
  char rate[32];
  std::snprintf(rate, sizeof(rate), "%g", 1.0 / skills::SkillOptions().decision_seconds());
  return {{"task", source.name},
          {"robot", source.robot},
          {"action_space", skills::NameOf(source.action)},
          {"observation_size", std::to_string(source.policy.observation_size())},
          {"action_size", std::to_string(source.policy.action_size())},
          {"control_rate_hz", rate},
          {"version", kProgramVersion}};
}

ExportedPolicy WriteSource(const PolicySource& source, PolicyFormat format, const fs::path& file) {
  ExportedPolicy exported{source.name, file, source.policy.observation_size(),
                          source.policy.action_size(), PolicyMetadata(source)};
  if (format == PolicyFormat::kOnnx) {
    rl::WriteOnnx(source.policy, exported.metadata, file);
  } else {
    rl::WriteTorchScript(source.policy, exported.metadata, file);
  }
  return exported;
}

}  // namespace

PolicyExportReport ExportPolicies(const PolicyExportRequest& request) {
  const std::vector<PolicySource> sources = SourcesOf(request);
  const std::string extension = Extension(request.format);
  PolicyExportReport report;
  report.output = request.output;
  if (sources.size() == 1) {
    if (request.output.extension() != extension) {
      throw core::Error("the extension must be " + extension, request.output.string());
    }
    if (fs::exists(request.output) && !request.force) {
      throw core::Error("the file exists", request.output.string(), "replace it with --force");
    }
    report.policies.push_back(WriteSource(sources.front(), request.format, request.output));
    return report;
  }
  core::StagedFolder staged(request.output, request.force);
  for (const PolicySource& source : sources) {
    report.policies.push_back(
        WriteSource(source, request.format, staged.staging() / (source.name + extension)));
    report.policies.back().file = request.output / (source.name + extension);
  }
  staged.Commit();
  return report;
}

std::string PolicyExportTable(const PolicyExportReport& report) {
  std::string table;
  char line[256];
  for (const ExportedPolicy& policy : report.policies) {
    std::snprintf(line, sizeof(line),
                  "%-40.40s  observation (batch x %d), action (batch x %d), %s\n",
                  policy.name.c_str(), policy.observation_size, policy.action_size,
                  policy.metadata.at("action_space").c_str());
    table += line;
  }
  return table;
}

std::string PolicyExportJson(const PolicyExportReport& report) {
  core::OrderedJson text = {{"output", report.output.string()},
                            {"policies", core::OrderedJson::array()}};
  for (const ExportedPolicy& policy : report.policies) {
    core::OrderedJson one = {{"name", policy.name}, {"file", policy.file.string()}};
    one["metadata"] = core::OrderedJson::object();
    for (const auto& [key, value] : policy.metadata) one["metadata"][key] = value;
    text["policies"].push_back(std::move(one));
  }
  return core::JsonText(text);
}

}  // namespace simwright::workflows
