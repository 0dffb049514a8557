#include "workflows/photo_run/photo_run_report.h"

#include <cstdio>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "core/finding_json.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStageRemedy = "--force starts over";
constexpr std::uint64_t kMaxStageBytes = 1 << 26;

core::OrderedJson ReadJson(const fs::path& file) {
  return core::ParseOrderedJson(core::ReadFile(file, kMaxStageBytes), file.string(), kStageRemedy);
}

// Returns the named members of `from`.
core::OrderedJson Some(const core::OrderedJson& from, const std::vector<std::string>& names) {
  core::OrderedJson some = core::OrderedJson::object();
  for (const std::string& name : names) {
    if (from.contains(name)) some[name] = from.at(name);
  }
  return some;
}

core::OrderedJson TaskJson(const tasks::Task& task) {
  core::OrderedJson json = {{"name", task.name}, {"description", task.description}};
  for (const tasks::Subtask& subtask : task.subtasks) {
    json["subtasks"].push_back({{"name", subtask.name},
                                {"description", subtask.description},
                                {"success", subtask.success}});
  }
  return json;
}

core::OrderedJson SuccessJson(const fs::path& rollout) {
  core::OrderedJson json =
      Some(ReadJson(rollout), {"episodes", "successes", "low", "high", "mean_seconds"});
  const core::JsonDocument document =
      core::JsonDocument::Read(rollout, kMaxStageBytes, kStageRemedy);
  for (const core::JsonField& subtask : document.root()["subtasks"].Elements()) {
    const int succeeded = subtask["succeeded"].Int(), tried = subtask["tried"].Int();
    const rl::Interval interval = rl::WilsonInterval(succeeded, tried);
    json["subtasks"].push_back({{"name", subtask["name"].Text()},
                                {"tried", tried},
                                {"succeeded", succeeded},
                                {"low", interval.low},
                                {"high", interval.high}});
  }
  return json;
}

core::OrderedJson TrajectoryJson(const PhotoRunFolder& folder, const std::string& refusal) {
  if (!refusal.empty()) return {{"refusal", refusal}};
  core::OrderedJson json = {{"file", folder.Trajectory().filename().string()}};
  json.update(
      Some(ReadJson(folder.Export()), {"mean_seconds", "stretch", "tool_deviation", "joints"}));
  const core::JsonDocument replay =
      core::JsonDocument::Read(folder.Replay(), kMaxStageBytes, kStageRemedy);
  json["replayed"] = replay.root()["successes"].Int() > 0;
  return json;
}

std::string Shown(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

// Quotes text for a shell.
std::string Quoted(const std::string& text) {
  if (text.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/") ==
          std::string::npos &&
      !text.empty()) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

core::Findings PhotoRunFindings(const PhotoRunFolder& folder) {
  core::Findings findings = assets::ReadAsset(folder.Asset()).findings;
  if (!fs::exists(folder.Export())) return findings;  // the motion was refused
  // Exports of earlier versions have no findings.
  const core::JsonDocument document =
      core::JsonDocument::Read(folder.Export(), 1 << 26, "--force starts over");
  if (document.root().Has("findings")) {
    const core::Findings exported = core::FindingsFrom(document.root()["findings"]);
    findings.insert(findings.end(), exported.begin(), exported.end());
  }
  return findings;
}

core::OrderedJson PhotoRunReport(const PhotoRunRequest& request, const PhotoRunFolder& folder,
                                 const tasks::Task& task, const std::vector<RunStage>& stages,
                                 const std::string& refusal) {
  core::OrderedJson report = {{"format", 1},
                              {"photo", request.photo.filename().string()},
                              {"category", request.category},
                              {"seed", request.seed},
                              {"command", PhotoRunCommand(request)}};
  report["asset"] = {{"folder", folder.asset_name}};
  report["asset"].update(Some(ReadJson(folder.Asset() / "asset.json"),
                              {"category", "size_m", "mass_kg", "material", "friction",
                               "restitution", "mass", "findings"}));
  report["findings"] = core::FindingsJson(PhotoRunFindings(folder));
  report["check"] = Some(ReadJson(folder.Check()), {"passed", "rows"});
  report["scene"] = ReadJson(folder.Scene());
  report["task"] = TaskJson(task);
  report["training"] = Some(ReadJson(folder.Skill() / "report.json"), {"subtasks", "chain"});
  report["success"] = SuccessJson(folder.Rollout());
  report["trajectory"] = TrajectoryJson(folder, refusal);
  double seconds = 0.0;
  report["stages"] = core::OrderedJson::array();
  for (const RunStage& stage : stages) {
    report["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
    seconds += stage.seconds;
  }
  report["seconds"] = seconds;
  return report;
}

std::string PhotoRunCommand(const PhotoRunRequest& request) {
  const PhotoRunRequest usual;
  // Pages may be passed on and must not contain their maker's folders.
  const auto file = [](const fs::path& path) {
    return Quoted(path.is_absolute() ? path.filename().string() : path.string());
  };
  std::string command =
      "simwright run " + file(request.photo) + " --category " + Quoted(request.category);
  const auto add = [&](bool given, const std::string& flag, const std::string& value) {
    if (given) command += " " + flag + " " + value;
  };
  add(request.mask.has_value(), "--mask", request.mask ? file(*request.mask) : "");
  add(request.height > 0.0, "--height", Shown(request.height));
  add(request.effort == asset_lift::LiftEffort::kFull, "--lift", "full");
  add(request.effort == asset_lift::LiftEffort::kOutline, "--lift", "outline");
  add(request.furniture != usual.furniture, "--furniture", request.furniture);
  add(!request.task.empty(), "--task", Quoted(request.task));
  add(request.environments != usual.environments, "--envs", std::to_string(request.environments));
  add(request.samples != usual.samples, "--steps", std::to_string(request.samples));
  add(request.minutes != usual.minutes, "--minutes", Shown(request.minutes));
  add(request.target != usual.target, "--target", Shown(request.target));
  add(request.episodes != usual.episodes, "--episodes", std::to_string(request.episodes));
  add(request.seed != usual.seed, "--seed", std::to_string(request.seed));
  return command + " -o " + file(request.output);
}

}  // namespace simwright::workflows
