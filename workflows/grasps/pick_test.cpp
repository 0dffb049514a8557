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
#include "workflows/grasps/grasp_making.h"

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
  if (progress != nullptr) progress->Finish();
  return rows;
}

std::string PickTestTable(const std::vector<PickTestRow>& rows) {
  std::string table = "object                picks  proved  sampled\n";
  int picks = 0, proved = 0, sampled = 0;
  const auto add = [&](const std::string& name, int poses, int first, int second,
                       const std::string& failure) {
    char line[400];
    std::snprintf(line, sizeof(line), "%-20s  %5d  %6d  %7d  %s\n", name.c_str(), poses, first,
                  second, failure.c_str());
    table += line;
  };
  for (const PickTestRow& row : rows) {
    add(row.asset, row.poses, row.with_proved, row.with_sampled, row.failure);
    picks += row.poses;
    proved += row.with_proved;
    sampled += row.with_sampled;
  }
  add("all", picks, proved, sampled, "");
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
                             {"failure", row.failure}});
  }
  return core::JsonText(json);
}

}  // namespace simwright::workflows
