#include "viewer/contents/task_view.h"

#include <utility>

#include "core/error.h"
#include "robot/panda_model.h"
#include "tasks/task_file.h"
#include "viewer/contents/asset_view.h"
#include "viewer/model_document.h"

namespace simwright::viewer {
namespace fs = std::filesystem;

using core::OrderedJson;

TaskModels::TaskModels(const tasks::TaskSet& set, const robot::RobotModel& robot,
                       DocumentBuilder* builder)
    : set_(set), robot_(robot), builder_(builder) {}

int TaskModels::Robot() {
  if (robot_model_ >= 0) return robot_model_;
  OrderedJson model = ModelOf(robot_.urdf, robot_.name, builder_);
  model["camera_link"] = robot_.tool_link;
  return robot_model_ = builder_->AddModel(std::move(model));
}

int TaskModels::Asset(const std::string& name) {
  const auto found = models_.find(name);
  if (found != models_.end()) return found->second;
  for (const tasks::TaskAsset& asset : set_.assets) {
    if (asset.name != name) continue;
    OrderedJson model = ModelOfPath(asset.path, builder_);
    model["name"] = name;
    return models_[name] = builder_->AddModel(std::move(model));
  }
  throw core::Error("the set has no such asset", name);
}

std::vector<WorldBody> TaskModels::BodiesAtStart(const tasks::InitialState& start) {
  std::vector<WorldBody> bodies = {
      {robot_.name, Robot(), start.world_from_robot, true, HomePositions(robot_)}};
  for (const tasks::AssetPlacement& placement : start.placements) {
    WorldBody& body = bodies.emplace_back();
    body = {placement.asset, Asset(placement.asset), placement.world_from_asset, placement.fixed};
    for (const tasks::JointCondition& joint : start.joints) {
      if (joint.asset == placement.asset) {
        body.positions.emplace_back(joint.joint, joint.position);
      }
    }
  }
  return bodies;
}

std::vector<std::pair<std::string, double>> HomePositions(const robot::RobotModel& robot) {
  std::vector<std::pair<std::string, double>> positions;
  for (std::size_t i = 0; i < robot.arm_joints.size(); ++i) {
    const auto joint = static_cast<std::size_t>(robot.arm_joints[i]);
    positions.emplace_back(robot.urdf.joints[joint].name,
                           robot.home()[static_cast<Eigen::Index>(i)]);
  }
  if (!robot.gripper.joints.empty()) {
    const auto leader = static_cast<std::size_t>(robot.gripper.joints.front());
    positions.emplace_back(robot.urdf.joints[leader].name, robot.gripper.open);
  }
  return positions;
}

OrderedJson SubtaskWorld(const tasks::Task& task, const tasks::Subtask& subtask,
                         TaskModels* models) {
  const bool alone = task.subtasks.size() == 1;
  OrderedJson world = {{"name", alone ? task.name : subtask.name}};
  if (!alone) world["group"] = task.name;
  world["description"] =
      alone ? subtask.description : task.description + " – " + subtask.description;
  Facts facts = {{"success", subtask.success}, {"source", task.source}};
  if (!subtask.start.held.empty()) facts.emplace_back("held at the start", subtask.start.held);
  for (const core::Finding& finding : subtask.findings) {
    facts.emplace_back("finding", finding.sentence);
  }
  world["facts"] = FactsJson(facts);
  if (!subtask.program.empty()) world["code"] = subtask.program;
  if (subtask.goal) {
    world["markers"] = OrderedJson::array();
    world["markers"].push_back({{"name", "goal"}, {"position", VectorNumbers(*subtask.goal)}});
  }
  world["bodies"] = BodiesJson(models->BodiesAtStart(subtask.start));
  return world;
}

std::unique_ptr<Content> ReadTasksView(const fs::path& file) {
  const tasks::TaskSet set = tasks::ReadTaskFile(file);
  DocumentBuilder builder(
      "tasks", fs::absolute(file).lexically_normal().parent_path().filename().string() + "/" +
                   file.filename().string());
  TaskModels models(set, robot::Panda(false), &builder);
  std::string fault = "it has no tasks";
  int shown = 0;
  for (const tasks::Task& task : set.tasks) {
    try {
      for (const tasks::Subtask& subtask : task.subtasks) {
        builder.AddWorld(SubtaskWorld(task, subtask, &models));
        ++shown;
      }
    } catch (const core::Error& error) {
      fault = error.what();
      AddFinding({"view-task-not-shown", core::Severity::kError, task.name, fault}, &builder);
    }
  }
  if (shown == 0) throw core::Error("no task can be shown: " + fault, file.string());
  return std::make_unique<Content>(builder.Take());
}

}  // namespace simwright::viewer
