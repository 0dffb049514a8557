#include "workflows/skills/motion_files.h"

#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "robot/trajectory_file.h"
#include "robot/trajectory_joints.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

using robot::JointTrajectory;

constexpr char kGripperKey[] = "gripper";      // in the arm's file: there is also a gripper file
constexpr char kJointsKey[] = "robot_joints";  // the robot's names, in column order

bool IsRos(const fs::path& file) {
  return robot::TrajectoryFormatOf(file) != robot::TrajectoryFormat::kCsv;
}

std::string WithSpaces(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

void WriteWithMetadata(const JointTrajectory& trajectory, const fs::path& file) {
  robot::WriteTrajectory(file, trajectory);
  if (file.extension() != ".json") return;
  core::WriteFile(MetadataFileBeside(file), core::JsonText(core::Json(trajectory.metadata)));
}

std::map<std::string, std::string> NotesOfJson(const fs::path& file) {
  const fs::path metadata = MetadataFileBeside(file);
  if (!fs::exists(metadata)) {
    throw core::Error("its metadata file is not beside it", file.string(),
                      "keep " + metadata.filename().string() + " with it, or export YAML");
  }
  const core::JsonDocument document =
      core::JsonDocument::Read(metadata, 1 << 24, "export it again");
  std::map<std::string, std::string> lines;
  for (const auto& [name, field] : document.root().Members()) lines[name] = field.Text();
  return lines;
}

// Renames the joints to the robot's own names, which the metadata lists.
JointTrajectory UnderOwnNames(JointTrajectory trajectory, const fs::path& file) {
  const auto note = trajectory.metadata.find(kJointsKey);
  if (note == trajectory.metadata.end()) return trajectory;
  std::istringstream words(note->second);
  std::vector<std::string> own;
  for (std::string word; words >> word;) own.push_back(word);
  if (own.size() != trajectory.joints.size()) {
    throw core::Error("its metadata entry '" + std::string(kJointsKey) + "' names " +
                          std::to_string(own.size()) + " joints, it has " +
                          std::to_string(trajectory.joints.size()),
                      file.string(), "export it again");
  }
  trajectory.joints = own;
  trajectory.metadata.erase(kJointsKey);
  return trajectory;
}

}  // namespace

fs::path GripperBeside(const fs::path& motion) {
  return fs::path(motion).replace_extension(".gripper" + motion.extension().string());
}

fs::path MetadataFileBeside(const fs::path& motion) {
  return fs::path(motion).replace_extension(".notes.json");
}

bool IsMotionSideFile(const fs::path& file) {
  const std::string stem = file.stem().string();
  return stem.ends_with(".gripper") || stem.ends_with(".notes");
}

void WriteMotion(const JointTrajectory& trajectory, const fs::path& file,
                 const robot::JointNames& names) {
  JointTrajectory named = robot::Renamed(trajectory, names.names);
  if (named.joints != trajectory.joints) named.metadata[kJointsKey] = WithSpaces(trajectory.joints);
  if (!IsRos(file)) {
    WriteWithMetadata(named, file);
    return;
  }
  const std::vector<std::string> arm(named.joints.begin(), named.joints.end() - 1);
  JointTrajectory of_arm = robot::JointsOf(named, arm);
  of_arm.metadata[kGripperKey] = "beside";
  WriteWithMetadata(of_arm, file);
  JointTrajectory gripper = robot::JointsOf(named, {named.joints.back()});
  gripper.metadata = {{"beside", file.filename().string()}};
  robot::WriteTrajectory(GripperBeside(file), gripper);
}

JointTrajectory ReadMotion(const fs::path& file) {
  JointTrajectory trajectory = robot::ReadTrajectory(file);
  if (file.extension() == ".json") trajectory.metadata = NotesOfJson(file);
  if (trajectory.metadata.erase(kGripperKey) > 0) {
    const fs::path gripper = GripperBeside(file);
    if (!fs::exists(gripper)) {
      throw core::Error("the gripper's motion is not beside it", file.string(),
                        "keep " + gripper.filename().string() + " with it, or export again");
    }
    trajectory = robot::Joined(trajectory, robot::ReadTrajectory(gripper), gripper.string());
  }
  return UnderOwnNames(std::move(trajectory), file);
}

}  // namespace simwright::workflows
