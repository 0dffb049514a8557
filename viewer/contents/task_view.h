#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "robot/robot_model.h"
#include "tasks/task.h"
#include "viewer/content.h"

namespace simwright::viewer {

// The robot and the assets of a task set as models of a document, each added when it is first used.
class TaskModels {
 public:
  // `set` and `robot` must outlive this.
  TaskModels(const tasks::TaskSet& set, const robot::RobotModel& robot, DocumentBuilder* builder);

  // Return the index of a model. Throw core::Error if an asset cannot be read, or is not in the
  // set.
  int Robot();
  int Asset(const std::string& name);

  // Returns the bodies of a subtask's start: the robot at home with an open gripper, then the
  // placed assets.
  std::vector<WorldBody> BodiesAtStart(const tasks::InitialState& start);

 private:
  const tasks::TaskSet& set_;
  const robot::RobotModel& robot_;
  DocumentBuilder* builder_;
  int robot_model_ = -1;
  std::map<std::string, int> models_;
};

// Returns the joints of a robot's arm with their home positions, and the gripper's first, open.
std::vector<std::pair<std::string, double>> HomePositions(const robot::RobotModel& robot);

// Returns the entry of a subtask: its sentences, reward program, goal and bodies.
core::OrderedJson SubtaskWorld(const tasks::Task& task, const tasks::Subtask& subtask,
                               TaskModels* models);

// Returns the content of a tasks.json: an entry per subtask, with the Panda. Tasks with an asset
// that cannot be read are findings. Throws core::Error if the file is invalid, or no task can be
// shown.
std::unique_ptr<Content> ReadTasksView(const std::filesystem::path& file);

}  // namespace simwright::viewer
