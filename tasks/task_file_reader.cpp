#include <cmath>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "tasks/task_file.h"
#include "tasks/task_file_format.h"
#include "tasks/task_names.h"

namespace simwright::tasks {
namespace {

using core::JsonField;
namespace fs = std::filesystem;

Eigen::Isometry3d PoseFrom(const JsonField& value) {
  const std::vector<double> q = value["quaternion_wxyz"].Numbers(4);
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  constexpr double kTolerance = 1e-3;  // deviation of the length; quaternions typed by hand have a
                                       // few digits
  if (!(std::abs(rotation.norm() - 1.0) <= kTolerance)) {
    value["quaternion_wxyz"].Fail("must have length 1, has " + std::to_string(rotation.norm()));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = value["position"].Vector<3>();
  return pose;
}

std::string LinesFrom(const JsonField& value) {
  std::string text;
  const std::vector<JsonField> lines = value.Elements();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) text += '\n';
    text += lines[i].Text();
  }
  return text;
}

// A reader of tasks that may name only the given assets.
class TaskReader {
 public:
  explicit TaskReader(const std::vector<TaskAsset>& assets) {
    for (const TaskAsset& asset : assets) assets_.insert(asset.name);
  }

  Task TaskFrom(const JsonField& value) const {
    value.RequireMembers({"name", "description", "source", "assets", "subtasks", "findings"});
    Task task;
    task.name = value["name"].Text();
    if (task.name.empty()) value["name"].Fail("is empty");
    task.description = value["description"].Text();
    task.source = value["source"].Text();
    for (const JsonField& asset : value["assets"].Elements())
      task.assets.push_back(AssetFrom(asset));
    std::set<std::string> names;
    for (const JsonField& entry : value["subtasks"].Elements()) {
      task.subtasks.push_back(SubtaskFrom(entry));
      if (!names.insert(task.subtasks.back().name).second) {
        entry["name"].Fail("another subtask of the task has this name");
      }
    }
    task.findings = core::FindingsFrom(value["findings"]);
    return task;
  }

 private:
  std::string AssetFrom(const JsonField& value) const {
    const std::string name = value.Text();
    if (!assets_.contains(name)) value.Fail("no asset is called '" + name.substr(0, 64) + "'");
    return name;
  }

  Subtask SubtaskFrom(const JsonField& value) const {
    value.RequireMembers(
        {"name", "description", "program", "success", "start", "goal", "findings", "attempts"});
    Subtask subtask;
    subtask.name = value["name"].Text();
    if (subtask.name.empty()) value["name"].Fail("is empty");
    subtask.description = value["description"].Text();
    subtask.program = LinesFrom(value["program"]);
    subtask.success = value["success"].Text();
    subtask.start = StartFrom(value["start"]);
    if (!value["goal"].IsNull()) subtask.goal = value["goal"].Vector<3>();
    subtask.findings = core::FindingsFrom(value["findings"]);
    for (const JsonField& entry : value["attempts"].Elements()) {
      entry.RequireMembers({"program", "findings"});
      subtask.attempts.push_back(
          {LinesFrom(entry["program"]), core::FindingsFrom(entry["findings"])});
    }
    return subtask;
  }

  InitialState StartFrom(const JsonField& value) const {
    value.RequireMembers({"robot", "placements", "joints", "held"});
    InitialState start;
    value["robot"].RequireMembers({"position", "quaternion_wxyz"});
    start.world_from_robot = PoseFrom(value["robot"]);
    for (const JsonField& entry : value["placements"].Elements()) {
      entry.RequireMembers({"asset", "position", "quaternion_wxyz", "fixed"});
      start.placements.push_back(
          {AssetFrom(entry["asset"]), PoseFrom(entry), entry["fixed"].Flag()});
    }
    for (const JsonField& entry : value["joints"].Elements()) {
      entry.RequireMembers({"asset", "joint", "position"});
      start.joints.push_back(
          {AssetFrom(entry["asset"]), entry["joint"].Text(), entry["position"].Number()});
    }
    if (!value["held"].Text().empty()) start.held = AssetFrom(value["held"]);
    return start;
  }

  std::set<std::string> assets_;
};

TaskAsset TaskAssetFrom(const JsonField& value, const fs::path& folder) {
  value.RequireMembers({"name", "path", "category"});
  TaskAsset asset;
  asset.name = value["name"].Text();
  if (!IsAssetName(asset.name)) {
    value["name"].FailAs("a letter, then at most 63 letters, digits, '_' and '-'");
  }
  const std::string path = value["path"].Text();
  if (path.find('\0') != std::string::npos) value["path"].Fail("holds a zero byte");
  if (!path.empty()) asset.path = (folder / path).lexically_normal().string();
  asset.category = value["category"].Text();
  return asset;
}

}  // namespace

TaskSet ReadTaskFileText(std::string_view text, const std::string& where, const fs::path& folder) {
  const core::JsonDocument document(text, where);
  const JsonField root = document.root();
  if (!root.Has("format")) root.Fail("is not a task file: 'format' is missing");
  const double format = root["format"].Number();
  if (format > task_file::kFormat) {
    throw core::Error("is of format " + core::JsonLine(root["format"].json()) +
                          ", newer than this program's " + std::to_string(task_file::kFormat),
                      where, "read it with a newer simwright");
  }
  if (format != task_file::kFormat) root["format"].FailAs("1");
  root.RequireMembers({"format", "assets", "tasks"});
  TaskSet set;
  std::set<std::string> names;
  for (const JsonField& entry : root["assets"].Elements()) {
    set.assets.push_back(TaskAssetFrom(entry, folder));
    if (!names.insert(set.assets.back().name).second) {
      entry["name"].Fail("another asset has this name");
    }
  }
  const TaskReader reader(set.assets);
  names.clear();
  for (const JsonField& entry : root["tasks"].Elements()) {
    set.tasks.push_back(reader.TaskFrom(entry));
    if (!names.insert(set.tasks.back().name).second) {
      entry["name"].Fail("another task has this name");
    }
  }
  return set;
}

TaskSet ReadTaskFile(const fs::path& file) {
  return ReadTaskFileText(core::ReadFile(file, task_file::kLargest), file.string(),
                          file.parent_path());
}

}  // namespace simwright::tasks
