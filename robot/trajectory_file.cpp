#include "robot/trajectory_file.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "core/files.h"
#include "robot/number_text.h"
#include "robot/trajectory_formats.h"
#include "robot/trajectory_points.h"

namespace simwright::robot {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxTrajectoryBytes = 1ull << 30;

bool IsPlainName(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' ||
           c == '/';
  });
}

void RequireNotesFit(const JointTrajectory& trajectory) {
  for (const auto& [key, value] : trajectory.metadata) {
    const bool one_line = std::none_of(value.begin(), value.end(), [](char c) {
      return std::iscntrl(static_cast<unsigned char>(c));
    });
    if (!key.empty() && IsPlainName(key) && key != "samples" && one_line && !value.empty() &&
        Trimmed(value).size() == value.size()) {
      continue;
    }
    throw core::Error("the note '" + key + "' does not fit a trajectory file", "",
                      "use a plain name other than 'samples', and one line of text");
  }
}

}  // namespace

TrajectoryFormat TrajectoryFormatOf(const fs::path& path) {
  const std::string ending = path.extension();
  if (ending == ".yaml" || ending == ".yml") return TrajectoryFormat::kRosYaml;
  if (ending == ".json") return TrajectoryFormat::kRosJson;
  if (ending == ".csv") return TrajectoryFormat::kCsv;
  throw core::Error("'" + ending + "' is not an extension of a trajectory file", path.string(),
                    "use .yaml, .json or .csv");
}

std::string TrajectoryText(const JointTrajectory& trajectory, TrajectoryFormat format) {
  RequireWellFormed(trajectory, "trajectory");
  if (trajectory.joints.size() > kMostTrajectoryJoints ||
      trajectory.times.size() > kMostTrajectorySamples) {
    throw core::Error("the trajectory is larger than its readers accept", "trajectory");
  }
  for (const std::string& name : trajectory.joints) {
    if (IsPlainName(name)) continue;
    throw core::Error("the joint name '" + name + "' does not fit a trajectory file", "",
                      "use letters, digits, '_', '-', '.' and '/'");
  }
  RequireNotesFit(trajectory);
  switch (format) {
    case TrajectoryFormat::kRosYaml:
      return RosYamlText(trajectory);
    case TrajectoryFormat::kRosJson:
      return RosJsonText(trajectory);
    case TrajectoryFormat::kCsv:
      break;
  }
  return CsvText(trajectory);
}

JointTrajectory ParseTrajectory(const std::string& text, TrajectoryFormat format,
                                const std::string& where) {
  switch (format) {
    case TrajectoryFormat::kRosYaml:
      return ParseRosYaml(text, where);
    case TrajectoryFormat::kRosJson:
      return ParseRosJson(text, where);
    case TrajectoryFormat::kCsv:
      break;
  }
  return ParseCsv(text, where);
}

void WriteTrajectory(const fs::path& path, const JointTrajectory& trajectory) {
  core::WriteFile(path, TrajectoryText(trajectory, TrajectoryFormatOf(path)));
}

JointTrajectory ReadTrajectory(const fs::path& path) {
  const TrajectoryFormat format = TrajectoryFormatOf(path);
  return ParseTrajectory(core::ReadFile(path, kMaxTrajectoryBytes), format, path.string());
}

}  // namespace simwright::robot
