#include "workflows/tasks/reward_check.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/finding_text.h"
#include "core/json.h"
#include "reward/reward_program.h"
#include "tasks/verification/subtask_verifier.h"
#include "tasks/world_state.h"
#include "workflows/tasks/task_assets.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

// The size limit of a program file; the compiler's own bound is far below.
constexpr std::uint64_t kLargestProgram = 16u << 20;

// Returns a readable name of an input, such as "link_position of microwave, handle_0".
std::string ReadName(const reward::RewardSlot& slot) {
  std::string name(reward::RewardInputName(slot.input));
  if (!slot.asset.empty()) name += " of " + slot.asset;
  if (!slot.part.empty()) name += (slot.asset.empty() ? " " : ", ") + slot.part;
  return name;
}

// Returns true if the finding is about the program and not about an asset's file.
bool InProgram(const core::Finding& finding) {
  int line = 0, column = 0;
  return std::sscanf(finding.place.c_str(), "%d:%d", &line, &column) == 2;
}

int CountText(const core::Findings& findings, core::Severity severity) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const core::Finding& finding) { return finding.severity == severity; }));
}

// Examines the program on the scene (docs/rewards.md, "On a scene"); its title is the file's name.
core::Findings OnScene(const tasks::WorldModel& scene, const RewardCheckRequest& request,
                       const std::string& source) {
  tasks::VerificationOptions options;
  options.needs_success = false;
  options.entry = request.entry;
  tasks::SubtaskVerifier verifier(scene, options);
  tasks::Task task;
  tasks::Subtask subtask;
  subtask.name = request.program.stem().string();
  subtask.program = source;
  return verifier.Verify(task, &subtask);
}

}  // namespace

RewardCheckReport CheckReward(const RewardCheckRequest& request) {
  if (request.scene && request.assets.empty()) {
    throw core::Error("there are no assets to look up the program's names in", "",
                      "give --assets FOLDER..., or --no-scene for the function alone");
  }
  RewardCheckReport report;
  report.subject = request.program.string();
  report.source = core::ReadFile(request.program, kLargestProgram);
  tasks::WorldModel scene;
  if (request.scene) {
    const TaskAssets assets = ReadTaskAssets(request.assets);
    report.findings = assets.findings;
    scene = tasks::MakeWorldModel(assets.models);
  }
  reward::RewardOptions options;
  options.entry = request.entry;
  const reward::CompileOutcome outcome =
      reward::CompileReward(report.source, request.scene ? &scene.names : nullptr, options);
  core::Findings found = outcome.findings;
  if (request.scene && outcome.program) found = OnScene(scene, request, report.source);
  report.findings.insert(report.findings.end(), found.begin(), found.end());
  report.valid = CountText(found, core::Severity::kError) == 0;
  if (!outcome.program) return report;
  report.compiles = true;
  report.entry = outcome.program->entry();
  report.reads = outcome.program->slots();
  for (const reward::RewardComponent& part : outcome.program->components()) {
    report.components.push_back(part.name);
  }
  report.has_success = outcome.program->has_success();
  report.operations = outcome.program->operations();
  return report;
}

std::string RewardCheckText(const RewardCheckReport& report) {
  std::string text;
  for (const core::Finding& finding : report.findings) {
    text += InProgram(finding)
                ? report.subject + ":" + reward::RenderFinding(finding, report.source)
                : core::FindingText(finding, 0);
  }
  if (!report.passed()) {
    const int errors = CountText(report.findings, core::Severity::kError);
    return text + report.subject + " does not pass: " + std::to_string(errors) +
           (errors == 1 ? " error\n" : " errors\n");
  }
  text += report.subject + " passes: " + report.entry + " gives a reward" +
          (report.has_success ? " and success" : "");
  for (std::size_t i = 0; i < report.components.size(); ++i) {
    text += (i == 0 ? ", in components " : ", ") + report.components[i];
  }
  text += "; " + std::to_string(report.operations) + " operations per environment\n";
  for (const reward::RewardSlot& slot : report.reads) {
    text += "  reads " + ReadName(slot) + " " + slot.shape + "\n";
  }
  return text;
}

std::string RewardCheckJson(const RewardCheckReport& report) {
  core::OrderedJson json;
  json["program"] = report.subject;
  json["passed"] = report.passed();
  json["findings"] = core::FindingsJson(report.findings);
  if (report.passed()) {
    json["function"] = report.entry;
    json["success"] = report.has_success;
    json["components"] = report.components;
    json["operations"] = report.operations;
    json["reads"] = core::OrderedJson::array();
    for (const reward::RewardSlot& slot : report.reads) {
      json["reads"].push_back({{"input", reward::RewardInputName(slot.input)},
                               {"asset", slot.asset},
                               {"part", slot.part},
                               {"shape", slot.shape}});
    }
  }
  // A program may contain invalid UTF-8.
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

}  // namespace simwright::workflows
