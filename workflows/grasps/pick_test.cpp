#include "workflows/grasps/pick_test.h"

#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "assets/asset_folder.h"
#include "assets/primitive_meshes.h"
#include "certificate/certificate.h"
#include "core/error.h"
#include "core/json.h"
#include "core/parallel.h"
#include "core/random.h"
#include "manipulation/grasp_file.h"
#include "robot/panda_model.h"
#include "skills/skill_evaluation.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/world_state.h"
#include "workflows/grasps/grasp_making.h"
#include "workflows/skills/skill_run.h"
#include "workflows/tasks/task_assets.h"

namespace simwright::workflows {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTableHeight = 0.3;  // m
// m: the planned lift, and that of the object's lowest point: a bowl that is held by its rim tilts.
constexpr double kPlannedLift = 0.10, kAskedLift = 0.05;
constexpr double kClearanceAbove = 0.001;  // m under the object at the start

// The robot stands 40 cm in front of the table's edge, 12 cm below its top.
const Vector3d kPickRobotBase(-0.4, 0.0, 0.18);

std::shared_ptr<const certificate::BodyModel> PickTable() {
  sim::RigidBody table;
  table.name = "table";
  table.parts = {assets::BoxMesh({0.6, 0.8, kTableHeight})};
  table.inertial.mass = 50.0;
  return std::make_shared<certificate::BodyModel>(table);
}

// One object, with proved grasps and without.
struct PickObject {
  std::shared_ptr<const certificate::BodyModel> proved, plain;
};

PickObject ReadPickObject(const std::filesystem::path& folder) {
  const assets::Asset asset = assets::ReadAsset(folder);
  const manipulation::GraspSet set =
      manipulation::ReadGraspSet(folder / manipulation::kGraspFileName);
  const manipulation::GraspObject object = GraspObjectOf(asset);
  sim::RigidBody body = object.body;
  body.friction = object.friction;
  return {std::make_shared<certificate::BodyModel>(body, set.grasps),
          std::make_shared<certificate::BodyModel>(body)};
}

certificate::PlacedScene PickScene(std::shared_ptr<const certificate::BodyModel> table,
                                   std::shared_ptr<const certificate::BodyModel> object,
                                   const Isometry3d& world_from_object) {
  certificate::PlacedScene scene;
  scene.bodies.push_back({"table", std::move(table),
                          Isometry3d(Eigen::Translation3d(0.3, 0.0, 0.5 * kTableHeight)), true});
  scene.bodies.push_back({"object", std::move(object), world_from_object, false});
  return scene;
}

// Returns the successes of the scripted expert in `episodes` episodes of the subtask that picks up
// the asset in `folder`; 0 if the rules make no such subtask.
int ExpertPicks(const std::filesystem::path& folder, bool proved_grasps, int episodes,
                std::uint64_t seed) {
  tasks::TaskSet set;
  TaskAssets assets = ReadTaskAssets({"object=" + folder.string()});
  set.assets = assets.listed;
  // The object is picked up whatever its grasps: an expert that takes it from above knows none.
  assets.models.front().graspable = true;
  const tasks::RuleOptions options{.count = 0, .seed = seed};
  const tasks::RuleTasks made =
      tasks::GenerateTasksByRules(tasks::MakeWorldModel(assets.models), options);
  for (const tasks::Task& task : made.tasks) {
    if (task.name != "pick_up_object") continue;
    set.tasks = {task};
    set.tasks.front().subtasks.resize(1);
    break;
  }
  if (set.tasks.empty()) return 0;
  SkillRun run;
  run.set = set;
  run.proved_grasps = proved_grasps;
  const std::vector<RunSkill> skills = PrepareSkills(run);
  const skills::Skill& skill = *skills.front().evaluated;
  return skills::EvaluateScriptedExpert(skill, skills::SampleStarts(skill, episodes, seed))
      .successes;
}

// Plans a pick and replays it; returns why it failed, or nothing.
std::string FailureOfPick(const certificate::Planner& planner,
                          const certificate::PlacedScene& scene) {
  const Isometry3d robot(Eigen::Translation3d{kPickRobotBase});
  certificate::Goal planned = certificate::LiftGoal(), asked = planned;
  planned.lift = kPlannedLift;
  asked.lift = kAskedLift;
  certificate::MotionSearch search(planner, scene, 1, planned, robot, {});
  const std::optional<certificate::MotionPlan> plan = search.Next();
  if (!plan) return "no plan";
  try {
    const certificate::TimedMotion motion =
        certificate::TrajectoryOf(*plan, planner.robot(), certificate::TrajectoryOptions());
    const certificate::Proof proof =
        certificate::Replay(planner, scene, 1, asked, robot, motion.trajectory);
    return proof.success ? "" : "the robot " + proof.failure;
  } catch (const core::Cancelled&) {
    throw;
  } catch (const core::Error& error) {
    return error.what();
  }
}

}  // namespace

std::vector<PickTestRow> RunPickTest(const PickTestRequest& request, core::Progress* progress) {
  if (request.assets.empty()) throw core::Error("no asset given", "", "give an asset's folder");
  std::vector<PickObject> objects;
  std::vector<PickTestRow> rows;
  for (const std::filesystem::path& folder : request.assets) {
    objects.push_back(ReadPickObject(folder));
    PickTestRow row;
    row.asset = folder.filename().string();
    row.poses = request.poses;
    rows.push_back(row);
  }
  certificate::GraspOptions grasps;
  grasps.proved_alone = true;
  const certificate::Planner planner(robot::Panda(false), grasps, request.seed);
  const auto table = PickTable();
  const int picks = static_cast<int>(objects.size()) * request.poses;
  std::vector<std::string> proved(static_cast<size_t>(picks)), sampled = proved;
  if (progress != nullptr) progress->Stage("picks", picks);
  core::ParallelFor(picks, [&](int pick) {
    const PickObject& object = objects[static_cast<size_t>(pick / request.poses)];
    core::Rng rng = core::StreamRng(request.seed, static_cast<std::uint64_t>(pick));
    Isometry3d pose(Eigen::Translation3d(core::Uniform(rng, 0.1, 0.25),
                                         core::Uniform(rng, -0.15, 0.15),
                                         kTableHeight + kClearanceAbove));
    pose.rotate(
        Eigen::AngleAxisd(core::Uniform(rng, 0.0, 2.0 * std::numbers::pi), Vector3d::UnitZ()));
    const auto index = static_cast<size_t>(pick);
    proved[index] = FailureOfPick(planner, PickScene(table, object.proved, pose));
    sampled[index] = FailureOfPick(planner, PickScene(table, object.plain, pose));
    if (progress != nullptr) progress->Advance();
  });
  for (size_t i = 0; i < static_cast<size_t>(picks); ++i) {
    PickTestRow& row = rows[i / static_cast<size_t>(request.poses)];
    row.with_proved += proved[i].empty() ? 1 : 0;
    row.with_sampled += sampled[i].empty() ? 1 : 0;
    if (!proved[i].empty()) row.failure = proved[i];
  }
  if (progress != nullptr) progress->Stage("expert", static_cast<std::int64_t>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].expert_proved = ExpertPicks(request.assets[i], true, request.poses, request.seed);
    rows[i].expert_from_above = ExpertPicks(request.assets[i], false, request.poses, request.seed);
    if (progress != nullptr) progress->Advance();
  }
  if (progress != nullptr) progress->Finish();
  return rows;
}

std::string PickTestTable(const std::vector<PickTestRow>& rows) {
  std::string table =
      "                             planner          scripted expert\n"
      "object                picks  proved  sampled  proved  from above\n";
  PickTestRow all;
  all.asset = "all";
  const auto add = [&](const PickTestRow& row) {
    char line[400];
    std::snprintf(line, sizeof(line), "%-20s  %5d  %6d  %7d  %6d  %10d  %s\n", row.asset.c_str(),
                  row.poses, row.with_proved, row.with_sampled, row.expert_proved,
                  row.expert_from_above, row.failure.c_str());
    table += line;
  };
  for (const PickTestRow& row : rows) {
    add(row);
    all.poses += row.poses;
    all.with_proved += row.with_proved;
    all.with_sampled += row.with_sampled;
    all.expert_proved += row.expert_proved;
    all.expert_from_above += row.expert_from_above;
  }
  add(all);
  return table;
}

std::string PickTestJson(const std::vector<PickTestRow>& rows) {
  core::OrderedJson json;
  json["picks"] = core::OrderedJson::array();
  for (const PickTestRow& row : rows) {
    json["picks"].push_back({{"asset", row.asset},
                             {"poses", row.poses},
                             {"with_proved", row.with_proved},
                             {"with_sampled", row.with_sampled},
                             {"expert_proved", row.expert_proved},
                             {"expert_from_above", row.expert_from_above},
                             {"failure", row.failure}});
  }
  return core::JsonText(json);
}

}  // namespace simwright::workflows
