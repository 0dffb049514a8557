#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "tasks/task_file.h"
#include "tasks/task_file_format.h"
#include "tasks/task_names.h"

namespace simwright::tasks {
namespace {

using TaskJson = nlohmann::json;
namespace fs = std::filesystem;

constexpr int kDeepestTaskFile = 32;  // nesting levels; the format has 8

// A JSON value with its position in the file. Its accessors throw core::Error if it is not of the
// requested type.
class Value {
 public:
  Value(const TaskJson& json, std::string place, const std::string& file)
      : json_(json), place_(std::move(place)), file_(file) {}

  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(what, file_ + (place_.empty() ? "" : ": " + place_));
  }

  // Throws core::Error unless this is an object with exactly these members and any of the
  // `optional` ones.
  void RequireMembers(std::initializer_list<const char*> names,
                      std::initializer_list<const char*> optional = {}) const {
    if (!json_.is_object()) Fail("should be an object");
    for (const auto& member : json_.items()) {
      const std::string& key = member.key();
      const auto same = [&](const char* name) { return key == name; };
      const bool known = std::any_of(names.begin(), names.end(), same) ||
                         std::any_of(optional.begin(), optional.end(), same);
      if (!known) Fail("'" + key.substr(0, 40) + "' is not a known member");
    }
    for (const char* name : names) {
      if (!json_.contains(name)) Fail(std::string("'") + name + "' is missing");
    }
  }

  Value operator[](const char* name) const {
    return Value(json_.at(name), place_.empty() ? name : place_ + "." + name, file_);
  }

  std::vector<Value> Elements() const {
    if (!json_.is_array()) Fail("should be an array");
    std::vector<Value> elements;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      elements.emplace_back(json_[i], place_ + "[" + std::to_string(i) + "]", file_);
    }
    return elements;
  }

  bool Holds(const char* name) const { return json_.contains(name); }
  bool is_null() const { return json_.is_null(); }

  std::string Text() const {
    if (!json_.is_string()) Fail("should be text");
    return json_.get<std::string>();
  }

  bool Flag() const {
    if (!json_.is_boolean()) Fail("should be true or false");
    return json_.get<bool>();
  }

  double Number() const {
    if (!json_.is_number()) Fail("should be a number");
    const double number = json_.get<double>();
    if (!std::isfinite(number)) Fail("the number is too large");
    return number;
  }

  std::vector<double> Numbers(std::size_t count) const {
    const std::vector<Value> elements = Elements();
    if (elements.size() != count) Fail("should hold " + std::to_string(count) + " numbers");
    std::vector<double> numbers;
    for (const Value& element : elements) numbers.push_back(element.Number());
    return numbers;
  }

 private:
  const TaskJson& json_;
  std::string place_;
  const std::string& file_;
};

Eigen::Vector3d VectorFrom(const Value& value) {
  const std::vector<double> n = value.Numbers(3);
  return {n[0], n[1], n[2]};
}

Eigen::Isometry3d PoseFrom(const Value& value) {
  const std::vector<double> q = value["quaternion_wxyz"].Numbers(4);
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  constexpr double kTolerance = 1e-3;  // deviation of the length; quaternions typed by hand have a
                                       // few digits
  if (!(std::abs(rotation.norm() - 1.0) <= kTolerance)) {
    value["quaternion_wxyz"].Fail("should have length 1, has " + std::to_string(rotation.norm()));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = VectorFrom(value["position"]);
  return pose;
}

std::string LinesFrom(const Value& value) {
  std::string text;
  const std::vector<Value> lines = value.Elements();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) text += '\n';
    text += lines[i].Text();
  }
  return text;
}

core::Findings FindingsFrom(const Value& value) {
  core::Findings findings;
  for (const Value& entry : value.Elements()) {
    entry.RequireMembers({"code", "severity", "place", "sentence", "figure"}, {"remedy"});
    core::Finding finding;
    finding.code = entry["code"].Text();
    const std::string severity = entry["severity"].Text();
    const auto* found =
        std::find(std::begin(task_file::kSeverities), std::end(task_file::kSeverities), severity);
    if (found == std::end(task_file::kSeverities)) {
      entry["severity"].Fail("should be info, warning or error");
    }
    finding.severity = static_cast<core::Severity>(found - std::begin(task_file::kSeverities));
    finding.place = entry["place"].Text();
    finding.sentence = entry["sentence"].Text();
    finding.figure = entry["figure"].Number();
    if (entry.Holds("remedy")) finding.remedy = entry["remedy"].Text();
    findings.push_back(std::move(finding));
  }
  return findings;
}

// A reader of tasks that may name only the given assets.
class TaskReader {
 public:
  explicit TaskReader(const std::vector<TaskAsset>& assets) {
    for (const TaskAsset& asset : assets) assets_.insert(asset.name);
  }

  Task TaskFrom(const Value& value) const {
    value.RequireMembers({"name", "description", "source", "assets", "subtasks", "findings"});
    Task task;
    task.name = value["name"].Text();
    if (task.name.empty()) value["name"].Fail("is empty");
    task.description = value["description"].Text();
    task.source = value["source"].Text();
    for (const Value& asset : value["assets"].Elements()) task.assets.push_back(AssetFrom(asset));
    std::set<std::string> names;
    for (const Value& entry : value["subtasks"].Elements()) {
      task.subtasks.push_back(SubtaskFrom(entry));
      if (!names.insert(task.subtasks.back().name).second) {
        entry["name"].Fail("another subtask of the task has this name");
      }
    }
    task.findings = FindingsFrom(value["findings"]);
    return task;
  }

 private:
  std::string AssetFrom(const Value& value) const {
    const std::string name = value.Text();
    if (!assets_.contains(name)) value.Fail("no asset is called '" + name.substr(0, 64) + "'");
    return name;
  }

  Subtask SubtaskFrom(const Value& value) const {
    value.RequireMembers(
        {"name", "description", "program", "success", "start", "goal", "findings", "attempts"});
    Subtask subtask;
    subtask.name = value["name"].Text();
    if (subtask.name.empty()) value["name"].Fail("is empty");
    subtask.description = value["description"].Text();
    subtask.program = LinesFrom(value["program"]);
    subtask.success = value["success"].Text();
    subtask.start = StartFrom(value["start"]);
    if (!value["goal"].is_null()) subtask.goal = VectorFrom(value["goal"]);
    subtask.findings = FindingsFrom(value["findings"]);
    for (const Value& entry : value["attempts"].Elements()) {
      entry.RequireMembers({"program", "findings"});
      subtask.attempts.push_back({LinesFrom(entry["program"]), FindingsFrom(entry["findings"])});
    }
    return subtask;
  }

  InitialState StartFrom(const Value& value) const {
    value.RequireMembers({"robot", "placements", "joints", "held"});
    InitialState start;
    value["robot"].RequireMembers({"position", "quaternion_wxyz"});
    start.world_from_robot = PoseFrom(value["robot"]);
    for (const Value& entry : value["placements"].Elements()) {
      entry.RequireMembers({"asset", "position", "quaternion_wxyz", "fixed"});
      start.placements.push_back(
          {AssetFrom(entry["asset"]), PoseFrom(entry), entry["fixed"].Flag()});
    }
    for (const Value& entry : value["joints"].Elements()) {
      entry.RequireMembers({"asset", "joint", "position"});
      start.joints.push_back(
          {AssetFrom(entry["asset"]), entry["joint"].Text(), entry["position"].Number()});
    }
    if (!value["held"].Text().empty()) start.held = AssetFrom(value["held"]);
    return start;
  }

  std::set<std::string> assets_;
};

TaskAsset TaskAssetFrom(const Value& value, const fs::path& folder) {
  value.RequireMembers({"name", "path", "category"});
  TaskAsset asset;
  asset.name = value["name"].Text();
  if (!IsAssetName(asset.name)) {
    value["name"].Fail("should be a letter, then at most 63 letters, digits, '_' and '-'");
  }
  const std::string path = value["path"].Text();
  if (path.find('\0') != std::string::npos) value["path"].Fail("holds a zero byte");
  if (!path.empty()) asset.path = (folder / path).lexically_normal().string();
  asset.category = value["category"].Text();
  return asset;
}

TaskJson Parsed(std::string_view text, const std::string& where) {
  bool too_deep = false;
  const auto bounded = [&too_deep](int depth, TaskJson::parse_event_t, TaskJson&) {
    too_deep = too_deep || depth >= kDeepestTaskFile;
    return !too_deep;
  };
  TaskJson json;
  try {
    json = TaskJson::parse(text, bounded);
  } catch (const TaskJson::parse_error& error) {
    if (too_deep) throw core::Error("is nested too deeply for tasks", where);
    const std::size_t end = std::min<std::size_t>(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(end), '\n');
    throw core::Error("is no JSON from line " + std::to_string(line) + " on", where);
  } catch (const TaskJson::exception&) {  // a number beyond the range of every type
    throw core::Error("holds a number that is too large", where);
  }
  if (too_deep) throw core::Error("is nested too deeply for tasks", where);
  return json;
}

}  // namespace

TaskSet ReadTaskFileText(std::string_view text, const std::string& where, const fs::path& folder) {
  const TaskJson json = Parsed(text, where);
  const Value root(json, "", where);
  if (!json.is_object() || !json.contains("format")) {
    root.Fail("is not a task file: 'format' is missing");
  }
  const double format = root["format"].Number();
  if (format > task_file::kFormat) {
    throw core::Error("is of format " + json["format"].dump() + ", newer than this program's " +
                          std::to_string(task_file::kFormat),
                      where, "read it with a newer simwright");
  }
  if (format != task_file::kFormat) root["format"].Fail("should be 1");
  root.RequireMembers({"format", "assets", "tasks"});
  TaskSet set;
  std::set<std::string> names;
  for (const Value& entry : root["assets"].Elements()) {
    set.assets.push_back(TaskAssetFrom(entry, folder));
    if (!names.insert(set.assets.back().name).second) {
      entry["name"].Fail("another asset has this name");
    }
  }
  const TaskReader reader(set.assets);
  names.clear();
  for (const Value& entry : root["tasks"].Elements()) {
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
