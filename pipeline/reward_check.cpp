#include "pipeline/reward_check.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "assets/semantic_model.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "tasks/reward/reward_program.h"
#include "tasks/reward_names.h"

namespace simwright::pipeline {
namespace {

namespace fs = std::filesystem;

// A reward function is a page; the compiler's own bound is far below this.
constexpr std::uint64_t kLargestProgram = 16u << 20;

struct NamedAsset {
  std::string name;
  fs::path urdf;
};

NamedAsset Located(const std::string& argument) {
  NamedAsset asset;
  std::string place = argument;
  // A path that exists may hold an equals sign itself.
  const std::size_t equals = argument.find('=');
  if (equals != std::string::npos && !fs::exists(argument)) {
    asset.name = argument.substr(0, equals);
    place = argument.substr(equals + 1);
  }
  if (!fs::exists(place)) throw core::Error("no such asset", place, "give a folder or a .urdf");
  const bool folder = fs::is_directory(place);
  asset.urdf = folder ? assets::UrdfIn(place) : fs::path(place);
  if (asset.name.empty()) {
    const fs::path whole = fs::weakly_canonical(place);
    asset.name = folder ? whole.filename().string() : whole.stem().string();
  }
  return asset;
}

// The assets' names; what their files lack is reported beside.
tasks::RewardScene SceneOf(const std::vector<std::string>& arguments, core::Findings* findings) {
  tasks::RewardScene scene;
  for (const std::string& argument : arguments) {
    const NamedAsset asset = Located(argument);
    const bool taken = std::any_of(scene.assets.begin(), scene.assets.end(),
                                   [&](const auto& other) { return other.name == asset.name; });
    if (taken) {
      throw core::Error("two assets are called '" + asset.name + "'", argument,
                        "give one another name: NAME=PATH");
    }
    const assets::UrdfModel model = assets::ReadUrdf(asset.urdf);
    for (core::Finding finding : model.findings) {
      finding.place = asset.urdf.string() + (finding.place.empty() ? "" : ", " + finding.place);
      findings->push_back(finding);
    }
    scene.assets.push_back(tasks::NamesOf(asset.name, model));
  }
  return scene;
}

const char* SeverityName(core::Severity severity) {
  switch (severity) {
    case core::Severity::kError:
      return "error";
    case core::Severity::kWarning:
      return "warning";
    default:
      return "note";
  }
}

// "link_position of microwave, handle_0"
std::string ReadName(const tasks::RewardSlot& slot) {
  std::string name(tasks::RewardInputName(slot.input));
  if (!slot.asset.empty()) name += " of " + slot.asset;
  if (!slot.part.empty()) name += (slot.asset.empty() ? " " : ", ") + slot.part;
  return name;
}

// True where the finding is about the program and not about an asset's file.
bool InProgram(const core::Finding& finding) {
  int line = 0, column = 0;
  return std::sscanf(finding.place.c_str(), "%d:%d", &line, &column) == 2;
}

int Count(const core::Findings& findings, core::Severity severity) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const core::Finding& finding) { return finding.severity == severity; }));
}

}  // namespace

RewardCheckReport CheckReward(const RewardCheckRequest& request) {
  if (request.scene && request.assets.empty()) {
    throw core::Error("no assets are given to look the program's names up in", "",
                      "--assets FOLDER..., or --no-scene for the function alone");
  }
  RewardCheckReport report;
  report.subject = request.program.string();
  report.source = core::ReadFile(request.program, kLargestProgram);
  const tasks::RewardScene scene = SceneOf(request.assets, &report.findings);
  tasks::RewardOptions options;
  options.entry = request.entry;
  const tasks::CompileOutcome outcome =
      tasks::CompileReward(report.source, request.scene ? &scene : nullptr, options);
  report.findings.insert(report.findings.end(), outcome.findings.begin(), outcome.findings.end());
  if (!outcome.program) return report;
  report.compiles = true;
  report.entry = outcome.program->entry();
  report.reads = outcome.program->slots();
  for (const tasks::RewardComponent& part : outcome.program->components()) {
    report.components.push_back(part.name);
  }
  report.has_success = outcome.program->has_success();
  report.operations = outcome.program->operations();
  return report;
}

std::string RewardCheckText(const RewardCheckReport& report) {
  std::string text;
  for (const core::Finding& finding : report.findings) {
    text += InProgram(finding) ? report.subject + ":" + tasks::RenderFinding(finding, report.source)
                               : finding.place + ": " + SeverityName(finding.severity) + ": " +
                                     finding.sentence + "\n";
  }
  if (!report.passed()) {
    const int errors = Count(report.findings, core::Severity::kError);
    return text + report.subject + " does not pass: " + std::to_string(errors) +
           (errors == 1 ? " error\n" : " errors\n");
  }
  text += report.subject + " passes: " + report.entry + " gives a reward" +
          (report.has_success ? " and success" : "");
  for (std::size_t i = 0; i < report.components.size(); ++i) {
    text += (i == 0 ? ", in components " : ", ") + report.components[i];
  }
  text += "; " + std::to_string(report.operations) + " operations an environment\n";
  for (const tasks::RewardSlot& slot : report.reads) {
    text += "  reads " + ReadName(slot) + " " + slot.shape + "\n";
  }
  return text;
}

std::string RewardCheckJson(const RewardCheckReport& report) {
  nlohmann::ordered_json json;
  json["program"] = report.subject;
  json["passed"] = report.passed();
  json["findings"] = nlohmann::ordered_json::array();
  for (const core::Finding& finding : report.findings) {
    json["findings"].push_back({{"code", finding.code},
                                {"severity", SeverityName(finding.severity)},
                                {"place", finding.place},
                                {"sentence", finding.sentence}});
  }
  if (report.passed()) {
    json["function"] = report.entry;
    json["success"] = report.has_success;
    json["components"] = report.components;
    json["operations"] = report.operations;
    json["reads"] = nlohmann::ordered_json::array();
    for (const tasks::RewardSlot& slot : report.reads) {
      json["reads"].push_back({{"input", tasks::RewardInputName(slot.input)},
                               {"asset", slot.asset},
                               {"part", slot.part},
                               {"shape", slot.shape}});
    }
  }
  // A program may hold what is no UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace simwright::pipeline
