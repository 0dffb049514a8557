#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "tasks/task_file.h"
#include "tasks/task_file_format.h"

namespace simwright::tasks {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

double Finite(double value, const std::string& place) {
  if (!std::isfinite(value)) throw core::Error("the number is not finite", "tasks.json: " + place);
  return value;
}

Json ToJson(const Eigen::Vector3d& v, const std::string& place) {
  return {Finite(v.x(), place), Finite(v.y(), place), Finite(v.z(), place)};
}

// The quaternion that reading turns into a rotation which is written as the same quaternion again:
// going back and forth settles after a few steps of rounding.
Eigen::Quaterniond SettledRotation(const Eigen::Isometry3d& pose) {
  constexpr int kSteps = 20;
  Eigen::Quaterniond q(pose.linear());
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Quaterniond next(q.normalized().toRotationMatrix());
    if (next.coeffs() == q.coeffs()) break;
    q = next;
  }
  return q;
}

Json PoseJson(const Eigen::Isometry3d& pose, const std::string& place) {
  const Eigen::Quaterniond q = SettledRotation(pose);
  return {
      {"position", ToJson(Eigen::Vector3d(pose.translation()), place)},
      {"quaternion_wxyz",
       {Finite(q.w(), place), Finite(q.x(), place), Finite(q.y(), place), Finite(q.z(), place)}}};
}

// A program as its lines; joined by line breaks they give it back.
Json LinesJson(std::string_view text) {
  Json lines = Json::array();
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(std::string(text.substr(0, end)));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
    if (text.empty()) lines.push_back("");
  }
  return lines;
}

Json ToJson(const core::Findings& findings, const std::string& place) {
  Json list = Json::array();
  for (const core::Finding& f : findings) {
    list.push_back({{"code", f.code},
                    {"severity", task_file::kSeverities[static_cast<std::size_t>(f.severity)]},
                    {"place", f.place},
                    {"sentence", f.sentence},
                    {"figure", Finite(f.figure, place + ".figure")}});
  }
  return list;
}

Json ToJson(const InitialState& start, const std::string& place) {
  Json placements = Json::array();
  for (const AssetPlacement& placement : start.placements) {
    Json entry = {{"asset", placement.asset}};
    entry.update(PoseJson(placement.world_from_asset, place + ".placements"));
    entry["fixed"] = placement.fixed;
    placements.push_back(entry);
  }
  Json joints = Json::array();
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

Json ToJson(const Subtask& subtask, const std::string& place) {
  Json attempts = Json::array();
  for (const Attempt& attempt : subtask.attempts) {
    attempts.push_back({{"program", LinesJson(attempt.program)},
                        {"findings", ToJson(attempt.findings, place + ".attempts")}});
  }
  return {{"name", subtask.name},
          {"description", subtask.description},
          {"program", LinesJson(subtask.program)},
          {"success", subtask.success},
          {"start", ToJson(subtask.start, place + ".start")},
          {"goal", subtask.goal ? ToJson(*subtask.goal, place + ".goal") : Json(nullptr)},
          {"findings", ToJson(subtask.findings, place + ".findings")},
          {"attempts", attempts}};
}

Json ToJson(const Task& task, const std::string& place) {
  Json subtasks = Json::array();
  for (std::size_t i = 0; i < task.subtasks.size(); ++i) {
    subtasks.push_back(ToJson(task.subtasks[i], place + ".subtasks[" + std::to_string(i) + "]"));
  }
  return {{"name", task.name},     {"description", task.description},
          {"source", task.source}, {"assets", task.assets},
          {"subtasks", subtasks},  {"findings", ToJson(task.findings, place + ".findings")}};
}

// Relative to `folder` for what lies below it or beside it, so that both can be moved together.
std::string StoredPath(const std::string& path, const fs::path& folder) {
  if (path.empty()) return path;
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path relative = whole.lexically_relative(fs::absolute(folder / "").lexically_normal());
  int up = 0;
  for (const fs::path& step : relative) up += step == ".." ? 1 : 0;
  return relative.empty() || up > 1 ? whole.string() : relative.string();
}

}  // namespace

std::string TaskFileText(const TaskSet& set, const fs::path& folder) {
  Json assets = Json::array();
  for (const TaskAsset& asset : set.assets) {
    assets.push_back({{"name", asset.name},
                      {"path", StoredPath(asset.path, folder)},
                      {"category", asset.category}});
  }
  Json tasks = Json::array();
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    tasks.push_back(ToJson(set.tasks[i], "tasks[" + std::to_string(i) + "]"));
  }
  const Json json = {{"format", task_file::kFormat}, {"assets", assets}, {"tasks", tasks}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void WriteTaskFile(const TaskSet& set, const fs::path& file) {
  core::WriteFile(file, TaskFileText(set, file.parent_path()));
}

}  // namespace simwright::tasks
