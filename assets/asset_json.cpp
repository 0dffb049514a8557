#include "assets/asset_json.h"

namespace simwright::assets {
namespace {

constexpr const char* kSeverities[] = {"info", "warning", "error"};

}  // namespace

Json ToJson(const physics_params::Estimate& e) {
  return {{"min", e.min}, {"max", e.max}, {"sample", e.sample}, {"source", e.source}};
}

Json ToJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json ToJson(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(ToJson(Eigen::Vector3d(m.row(row))));
  return rows;
}

Json ToJson(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation", ToJson(Eigen::Vector3d(pose.translation()))}};
}

Json ToJson(const Inertial& inertial) {
  return {{"mass", inertial.mass},
          {"center_of_mass", ToJson(inertial.center_of_mass)},
          {"inertia", ToJson(inertial.inertia)}};
}

Json ToJson(const core::Findings& findings) {
  Json list = Json::array();
  for (const core::Finding& f : findings) {
    list.push_back({{"code", f.code},
                    {"severity", kSeverities[static_cast<int>(f.severity)]},
                    {"place", f.place},
                    {"sentence", f.sentence},
                    {"figure", f.figure}});
    if (!f.remedy.empty()) list.back()["remedy"] = f.remedy;
  }
  return list;
}

Json ToJson(const physics_params::PhysicalParameters& p) {
  Json json;
  json["category"] = p.category;
  json["category_resolution"] = p.resolution;
  json["size_m"] = {
      {"length", ToJson(p.length)}, {"width", ToJson(p.width)}, {"height", ToJson(p.height)}};
  json["mass_kg"] = ToJson(p.mass);
  json["material"] = {{"name", p.material},
                      {"fill", physics_params::FillName(p.fill)},
                      {"density_kg_m3", ToJson(p.density)}};
  json["friction"] = ToJson(p.friction);
  json["restitution"] = ToJson(p.restitution);
  return json;
}

physics_params::Estimate EstimateFrom(const Json& json) {
  return {json.at("min"), json.at("max"), json.at("sample"), json.at("source")};
}

Eigen::Vector3d VectorFrom(const Json& json) {
  return Eigen::Vector3d(json.at(0).get<double>(), json.at(1).get<double>(),
                         json.at(2).get<double>());
}

Eigen::Isometry3d PoseFrom(const Json& json) {
  const Json& q = json.at("rotation_wxyz");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(),
                                     q.at(2).get<double>(), q.at(3).get<double>())
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = VectorFrom(json.at("translation"));
  return pose;
}

Inertial InertialFrom(const Json& json) {
  Inertial inertial;
  inertial.mass = json.at("mass");
  inertial.center_of_mass = VectorFrom(json.at("center_of_mass"));
  for (int row = 0; row < 3; ++row) {
    inertial.inertia.row(row) = VectorFrom(json.at("inertia").at(row));
  }
  return inertial;
}

core::Findings FindingsFrom(const Json& json) {
  core::Findings findings;
  for (const Json& entry : json) {
    core::Finding finding{entry.at("code"),     core::Severity::kInfo, entry.at("place"),
                          entry.at("sentence"), entry.at("figure"),    entry.value("remedy", "")};
    for (int i = 0; i < 3; ++i) {
      if (entry.at("severity") == kSeverities[i]) {
        finding.severity = static_cast<core::Severity>(i);
      }
    }
    findings.push_back(finding);
  }
  return findings;
}

physics_params::PhysicalParameters ParametersFrom(const Json& json) {
  physics_params::PhysicalParameters p;
  p.category = json.at("category");
  p.resolution = json.at("category_resolution");
  p.length = EstimateFrom(json.at("size_m").at("length"));
  p.width = EstimateFrom(json.at("size_m").at("width"));
  p.height = EstimateFrom(json.at("size_m").at("height"));
  p.mass = EstimateFrom(json.at("mass_kg"));
  p.material = json.at("material").at("name");
  p.density = EstimateFrom(json.at("material").at("density_kg_m3"));
  p.friction = EstimateFrom(json.at("friction"));
  p.restitution = EstimateFrom(json.at("restitution"));
  return p;
}

}  // namespace simwright::assets
