#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "tasks/task_file.h"
#include "tasks/task_file_format.h"

namespace simwright::tasks {
namespace {

using core::OrderedJson;
namespace fs = std::filesystem;

double Finite(double value, const std::string& place) {
  if (!std::isfinite(value)) throw core::Error("the number is not finite", "tasks.json: " + place);
  return value;
}

OrderedJson ToJson(const Eigen::Vector3d& v, const std::string& place) {
  return {Finite(v.x(), place), Finite(v.y(), place), Finite(v.z(), place)};
}

// Returns the rotation as a quaternion of 12 decimals that reading and writing reproduce: repeated
// rounding and conversion to a matrix converge within a few steps.
Eigen::Quaterniond SettledRotation(const Eigen::Isometry3d& pose) {
  constexpr int kSteps = 50;
  constexpr double kDecimals = 1e12;
  const auto rounded = [](Eigen::Quaterniond q) {
    for (double& c : q.coeffs()) c = std::round(c * kDecimals) / kDecimals + 0.0;  // no -0
    return q;
  };
  Eigen::Quaterniond q = rounded(Eigen::Quaterniond(pose.linear()));
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Quaterniond next = rounded(Eigen::Quaterniond(q.normalized().toRotationMatrix()));
    if (next.coeffs() == q.coeffs()) break;
    q = next;
  }
  return q;
}

OrderedJson PoseJson(const Eigen::Isometry3d& pose, const std::string& place) {
  const Eigen::Quaterniond q = SettledRotation(pose);
  return {
      {"position", ToJson(Eigen::Vector3d(pose.translation()), place)},
      {"quaternion_wxyz",
       {Finite(q.w(), place), Finite(q.x(), place), Finite(q.y(), place), Finite(q.z(), place)}}};
}

// Returns a program as its lines; joining them with line breaks restores it.
OrderedJson LinesJson(std::string_view text) {
  OrderedJson lines = OrderedJson::array();
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(std::string(text.substr(0, end)));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
    if (text.empty()) lines.push_back("");
  }
  return lines;
}

OrderedJson ToJson(const core::Findings& findings, const std::string& place) {
  for (const core::Finding& finding : findings) Finite(finding.figure, place + ".figure");
  return core::StoredFindingsJson(findings);
}

OrderedJson ToJson(const InitialState& start, const std::string& place) {
  OrderedJson placements = OrderedJson::array();
  for (const AssetPlacement& placement : start.placements) {
    OrderedJson entry = {{"asset", placement.asset}};
    entry.update(PoseJson(placement.world_from_asset, place + ".placements"));
    entry["fixed"] = placement.fixed;
    placements.push_back(entry);
  }
  OrderedJson joints = OrderedJson::array();
  for (const JointCondition& joint : start.joints) {
    joints.push_back({{"asset", joint.asset},
                      {"joint", joint.joint},
                      {"position", Finite(joint.position, place + ".joints")}});
  }
  return {{"robot", PoseJson(start.world_from_robot, place + ".robot")},
          {"placements", placements},
          {"joints", joints},
          {"held", start.held}};
}

OrderedJson ToJson(const Subtask& subtask, const std::string& place) {
  OrderedJson attempts = OrderedJson::array();
  for (const Attempt& attempt : subtask.attempts) {
    attempts.push_back({{"program", LinesJson(attempt.program)},
                        {"findings", ToJson(attempt.findings, place + ".attempts")}});
  }
  return {{"name", subtask.name},
          {"description", subtask.description},
          {"program", LinesJson(subtask.program)},
          {"success", subtask.success},
          {"start", ToJson(subtask.start, place + ".start")},
          {"goal", subtask.goal ? ToJson(*subtask.goal, place + ".goal") : OrderedJson(nullptr)},
          {"findings", ToJson(subtask.findings, place + ".findings")},
          {"attempts", attempts}};
}

OrderedJson ToJson(const Task& task, const std::string& place) {
  OrderedJson subtasks = OrderedJson::array();
  for (std::size_t i = 0; i < task.subtasks.size(); ++i) {
    subtasks.push_back(ToJson(task.subtasks[i], place + ".subtasks[" + std::to_string(i) + "]"));
  }
  return {{"name", task.name},     {"description", task.description},
          {"source", task.source}, {"assets", task.assets},
          {"subtasks", subtasks},  {"findings", ToJson(task.findings, place + ".findings")}};
}

// Returns a path relative to `folder` if it lies below it or below its parent, so that both can be
// moved together.
std::string StoredPath(const std::string& path, const fs::path& folder) {
  if (path.empty()) return path;
  const fs::path whole = fs::absolute(path).lexically_normal();
  // A file without a folder lies in the current folder, whose relative name is empty.
  const fs::path here = folder.empty() ? fs::current_path() : fs::absolute(folder);
  const fs::path relative = whole.lexically_relative((here / "").lexically_normal());
  int up = 0;
  for (const fs::path& step : relative) up += step == ".." ? 1 : 0;
  return relative.empty() || up > 1 ? whole.string() : relative.string();
}

// Appends `json` as Json::dump does, with related numbers on one line.
void AppendIndented(const OrderedJson& json, std::size_t indentation, std::string* text) {
  const auto leaf = [](const OrderedJson& value) {
    return !value.is_structured() || value.empty();
  };
  const bool numbers =
      json.is_array() &&
      std::all_of(json.begin(), json.end(), [](const OrderedJson& n) { return n.is_number(); });
  if (leaf(json) || numbers) {
    std::string line = core::JsonLine(json, core::InvalidUtf8::kReplace);
    for (std::size_t i = 0; numbers && i < line.size(); ++i) {
      if (line[i] == ',') line.insert(++i, " ");
    }
    *text += line;
    return;
  }
  *text += json.is_array() ? "[" : "{";
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    *text += (first ? "\n" : ",\n") + std::string(indentation + 2, ' ');
    if (json.is_object()) *text += '"' + key + "\": ";  // keys of the format need no escaping
    AppendIndented(value, indentation + 2, text);
    first = false;
  }
  *text += "\n" + std::string(indentation, ' ') + (json.is_array() ? "]" : "}");
}

}  // namespace

std::string TaskFileText(const TaskSet& set, const fs::path& folder) {
  OrderedJson assets = OrderedJson::array();
  for (const TaskAsset& asset : set.assets) {
    assets.push_back({{"name", asset.name},
                      {"path", StoredPath(asset.path, folder)},
                      {"category", asset.category}});
  }
  OrderedJson tasks = OrderedJson::array();
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    tasks.push_back(ToJson(set.tasks[i], "tasks[" + std::to_string(i) + "]"));
  }
  const OrderedJson json = {{"format", task_file::kFormat}, {"assets", assets}, {"tasks", tasks}};
  std::string text;
  AppendIndented(json, 0, &text);
  return text + "\n";
}

void WriteTaskFile(const TaskSet& set, const fs::path& file) {
  core::WriteFile(file, TaskFileText(set, file.parent_path()));
}

}  // namespace simwright::tasks
