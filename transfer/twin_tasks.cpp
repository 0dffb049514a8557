#include "transfer/twin_tasks.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/error.h"
#include "transfer/robot_placement.h"
#include "workflows/tasks/task_assets.h"
#include "workflows/twin/twin_record.h"

namespace simwright::transfer {
namespace {

Eigen::Isometry3d StatedBase(const Eigen::Vector3d& place) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(place.z(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() << place.x(), place.y(), 0.0;
  return pose;
}

core::Finding PlacedRobot(const RobotPlacement& placement) {
  const Eigen::Vector3d at = placement.world_from_robot.translation();
  const Eigen::Vector3d ahead = placement.world_from_robot.linear().col(0);
  const double yaw = std::atan2(ahead.y(), ahead.x()) * 180.0 / M_PI;
  char sentence[200];
  std::snprintf(sentence, sizeof sentence,
                "the robot's base stands on the table at x = %.3f m, y = %.3f m, turned by %.0f "
                "degrees, and reaches %d of %zu objects",
                at.x(), at.y(), yaw, placement.count(), placement.reached.size());
  return {"twin-robot-placed",
          core::Severity::kInfo,
          "",
          sentence,
          static_cast<double>(placement.count()),
          "--base X,Y,DEGREES states another place"};
}

}  // namespace

workflows::TasksReport MakeTwinTasks(const TwinTasksRequest& request, core::Progress* progress) {
  const workflows::TwinRecord record = workflows::ReadTwin(request.twin);
  if (record.objects.empty()) {
    throw core::Error("the twin has no objects", request.twin.string(),
                      "simwright twin --objects states what the photo shows");
  }
  workflows::TasksRequest wanted;
  tasks::InitialState layout;
  for (const workflows::TwinObject& object : record.objects) {
    wanted.assets.push_back(object.name + "=" + (request.twin / "assets" / object.name).string());
    layout.placements.push_back({object.name, object.world_from_object, object.articulated});
  }
  const tasks::WorldModel model =
      tasks::MakeWorldModel(workflows::ReadTaskAssets(wanted.assets).models);
  const tasks::WorldState state = tasks::StateOf(model, layout);
  const RobotPlacement placement = request.robot
                                       ? PlacementAt(model, state, StatedBase(*request.robot))
                                       : PlaceRobot(model, state);
  if (placement.count() == 0) {
    throw core::Error("the robot reaches none of the twin's objects", request.twin.string(),
                      request.robot ? "another --base, or none: it is then placed"
                                    : "--base X,Y,DEGREES states where it stands");
  }
  layout.world_from_robot = placement.world_from_robot;
  wanted.layout = layout;
  wanted.output = request.output;
  wanted.count = request.count;
  wanted.seed = request.seed;
  wanted.force = request.force;
  workflows::TasksReport report = workflows::MakeTasks(wanted, progress);
  report.findings.insert(report.findings.begin(), PlacedRobot(placement));
  for (size_t i = 0; i < placement.reached.size(); ++i) {
    if (placement.reached[i]) continue;
    report.findings.push_back({"twin-out-of-reach", core::Severity::kWarning, model.objects[i].name,
                               "the robot does not reach the object from above", 0.0,
                               "--base X,Y,DEGREES states another place of its base"});
  }
  return report;
}

}  // namespace simwright::transfer
