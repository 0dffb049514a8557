#include "core/json.h"
#include "robot/number_text.h"
#include "robot/trajectory_formats.h"
#include "robot/trajectory_points.h"

namespace simwright::robot {
namespace {

using core::JsonField;

void AppendJsonRow(const char* name, const Eigen::MatrixXd& matrix, Eigen::Index row,
                   std::string* text) {
  *text += '"';
  *text += name;
  *text += "\": [";
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    if (j > 0) *text += ", ";
    AppendNumber(matrix(row, j), text);
  }
  *text += "], ";
}

}  // namespace

std::string RosJsonText(const JointTrajectory& trajectory) {
  RequireRosTimes(trajectory);
  std::string text =
      "{\n  \"header\": {\"stamp\": {\"sec\": 0, \"nanosec\": 0}, \"frame_id\": \"\"},\n"
      "  \"joint_names\": [";
  for (std::size_t j = 0; j < trajectory.joints.size(); ++j) {
    text += (j > 0 ? ", \"" : "\"") + trajectory.joints[j] + "\"";
  }
  text += "],\n  \"points\": [\n";
  for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
    text += i == 0 ? "    {" : ",\n    {";
    AppendJsonRow("positions", trajectory.positions, i, &text);
    AppendJsonRow("velocities", trajectory.velocities, i, &text);
    AppendJsonRow("accelerations", trajectory.accelerations, i, &text);
    AppendJsonRow("effort", trajectory.efforts, i, &text);
    const TrajectoryPoint point = PointAt(trajectory.times[static_cast<std::size_t>(i)]);
    text += "\"time_from_start\": {\"sec\": " + std::to_string(point.sec) +
            ", \"nanosec\": " + std::to_string(point.nanosec) + "}}";
  }
  return text + "\n  ]\n}\n";
}

JointTrajectory ParseRosJson(const std::string& text, const std::string& where) {
  const core::JsonDocument document(text, where);
  const JsonField root = document.root();
  root.RequireMembers({"joint_names", "points"}, {"header"});
  TrajectoryPoints points(root["joint_names"].Names(), where);
  std::size_t index = 0;
  for (const JsonField& field : root["points"].Elements()) {
    field.RequireMembers({"positions", "time_from_start"},
                         {"velocities", "accelerations", "effort"});
    const JsonField time = field["time_from_start"];
    time.RequireMembers({"sec", "nanosec"});
    TrajectoryPoint point;
    point.sec = time["sec"].Integer();
    point.nanosec = time["nanosec"].Integer();
    point.positions = field["positions"].Numbers();
    if (field.Has("velocities")) point.velocities = field["velocities"].Numbers();
    if (field.Has("accelerations")) point.accelerations = field["accelerations"].Numbers();
    if (field.Has("effort")) point.effort = field["effort"].Numbers();
    points.Add(point, "points[" + std::to_string(index++) + "]");
  }
  return points.Finish();
}

}  // namespace simwright::robot
