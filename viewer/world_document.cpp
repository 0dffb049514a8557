#include "viewer/world_document.h"

#include <cmath>

namespace simwright::viewer {
namespace {

core::OrderedJson NumbersOrNull(const std::vector<double>& values) {
  core::OrderedJson list = core::OrderedJson::array();
  for (const double value : values) {
    list.push_back(std::isfinite(value) ? core::OrderedJson(value) : core::OrderedJson(nullptr));
  }
  return list;
}

}  // namespace

core::OrderedJson BodiesJson(const std::vector<WorldBody>& bodies) {
  core::OrderedJson list = core::OrderedJson::array();
  for (const WorldBody& body : bodies) {
    core::OrderedJson positions = core::OrderedJson::object();
    for (const auto& [joint, position] : body.positions) positions[joint] = position;
    list.push_back({{"name", body.name},
                    {"model", body.model},
                    {"pose", PoseNumbers(body.world_from_root)},
                    {"fixed", body.fixed},
                    {"positions", positions}});
  }
  return list;
}

core::OrderedJson TimelineJson(const Timeline& timeline) {
  core::OrderedJson json = {{"name", timeline.name},
                            {"rate", timeline.rate},
                            {"frames", timeline.frames()},
                            {"width", timeline.width},
                            {"tracks", core::OrderedJson::array()},
                            {"signals", core::OrderedJson::array()},
                            {"marks", core::OrderedJson::array()},
                            {"contacts", timeline.contacts},
                            {"contact_columns", timeline.contact_columns},
                            {"facts", FactsJson(timeline.facts)}};
  for (const Timeline::Track& track : timeline.tracks) {
    json["tracks"].push_back({{"body", track.body},
                              {"pose", track.pose},
                              {"joints", track.joints},
                              {"joint_columns", track.joint_columns}});
  }
  for (const Timeline::Signal& signal : timeline.signals) {
    json["signals"].push_back(
        {{"name", signal.name}, {"unit", signal.unit}, {"column", signal.column}});
  }
  for (const Timeline::Mark& mark : timeline.marks) {
    json["marks"].push_back({{"name", mark.name}, {"frame", mark.frame}});
  }
  return json;
}

std::string TimelineBytes(const Timeline& timeline) {
  return {reinterpret_cast<const char*>(timeline.rows.data()),
          timeline.rows.size() * sizeof(float)};
}

core::OrderedJson AddTimeline(const Timeline& timeline, DocumentBuilder* builder) {
  core::OrderedJson json = TimelineJson(timeline);
  json["buffer"] = builder->AddBuffer({TimelineBytes(timeline), "application/octet-stream"});
  return json;
}

void AppendPose(const Eigen::Isometry3d& pose, std::vector<float>* row) {
  const Eigen::Quaterniond turn(pose.linear());
  for (const double number : {pose.translation().x(), pose.translation().y(),
                              pose.translation().z(), turn.x(), turn.y(), turn.z(), turn.w()}) {
    row->push_back(static_cast<float>(number));
  }
}

core::OrderedJson ChartJson(const Chart& chart) {
  core::OrderedJson json = {{"title", chart.title},
                            {"x", chart.x_name},
                            {"y", chart.y_name},
                            {"curves", core::OrderedJson::array()}};
  for (const Curve& curve : chart.curves) {
    json["curves"].push_back({{"name", curve.name},
                              {"x", NumbersOrNull(curve.x)},
                              {"y", NumbersOrNull(curve.y)},
                              {"low", NumbersOrNull(curve.low)},
                              {"high", NumbersOrNull(curve.high)}});
  }
  return json;
}

}  // namespace simwright::viewer
