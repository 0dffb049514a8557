#include "assets/asset_json.h"

#include "core/error.h"

namespace simwright::assets {
namespace {

using core::JsonField;
using core::OrderedJson;

physics_params::Estimate EstimateFrom(const JsonField& field) {
  return {field["min"].Number(), field["max"].Number(), field["sample"].Number(),
          field["source"].Text()};
}

physics_params::StatedIntervals IntervalsFrom(const JsonField& field) {
  const auto range = [&](const char* key) {
    const std::vector<double> ends = field[key].Numbers(2);
    return physics_params::Interval{ends[0], ends[1]};
  };
  physics_params::StatedIntervals stated;
  stated.probability = physics_params::kStatedProbability;
  stated.longest_side = range("longest_side_m");
  stated.mass = range("mass_kg");
  stated.friction = range("friction");
  stated.basis = field["basis"].Text();
  return stated;
}

OrderedJson IntervalsToJson(const physics_params::StatedIntervals& stated) {
  const auto range = [](const physics_params::Interval& one) {
    return OrderedJson::array({one.min, one.max});
  };
  return {{"longest_side_m", range(stated.longest_side)},
          {"mass_kg", range(stated.mass)},
          {"friction", range(stated.friction)},
          {"basis", stated.basis}};
}

}  // namespace

OrderedJson ToJson(const physics_params::Estimate& e) {
  return {{"min", e.min}, {"max", e.max}, {"sample", e.sample}, {"source", e.source}};
}

OrderedJson ToJson(const Eigen::Vector3d& v) {
  return OrderedJson::array({v.x(), v.y(), v.z()});
}

OrderedJson ToJson(const Eigen::Matrix3d& m) {
  OrderedJson rows = OrderedJson::array();
  for (int row = 0; row < 3; ++row) rows.push_back(ToJson(Eigen::Vector3d(m.row(row))));
  return rows;
}

OrderedJson ToJson(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation", ToJson(Eigen::Vector3d(pose.translation()))}};
}

OrderedJson ToJson(const Inertial& inertial) {
  return {{"mass", inertial.mass},
          {"center_of_mass", ToJson(inertial.center_of_mass)},
          {"inertia", ToJson(inertial.inertia)}};
}

OrderedJson ToJson(const physics_params::PhysicalParameters& p) {
  OrderedJson json;
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
  if (p.intervals.probability > 0.0) json["interval_90"] = IntervalsToJson(p.intervals);
  return json;
}

core::Error InvalidName(const std::string& name, const std::string& file) {
  return core::Error(
      "'name' is '" + name.substr(0, 80) + "', which cannot name the asset's files", file,
      "use letters, digits, '_' and '-', as in '" + FileSafeName(name.substr(0, 80)) + "'");
}

core::JsonDocument ReadAssetJson(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "asset.json";
  core::JsonDocument document = core::JsonDocument::Read(file, kMaxAssetJsonBytes, kAssetRemedy);
  if (document.root()["format"].Int() > kFormatVersion) {
    throw core::Error("was written by a newer version", file.string(), "update simwright");
  }
  return document;
}

Eigen::Isometry3d PoseFrom(const JsonField& field) {
  const std::vector<double> q = field["rotation_wxyz"].Numbers(4);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  pose.translation() = field["translation"].Vector<3>();
  return pose;
}

Inertial InertialFrom(const JsonField& field) {
  Inertial inertial;
  inertial.mass = field["mass"].Number();
  inertial.center_of_mass = field["center_of_mass"].Vector<3>();
  const std::vector<JsonField> rows = field["inertia"].Elements(3);
  for (int row = 0; row < 3; ++row) {
    inertial.inertia.row(row) = rows[static_cast<size_t>(row)].Vector<3>();
  }
  return inertial;
}

physics_params::PhysicalParameters ParametersFrom(const JsonField& field) {
  physics_params::PhysicalParameters p;
  p.category = field["category"].Text();
  p.resolution = field["category_resolution"].Text();
  const JsonField size = field["size_m"];
  p.length = EstimateFrom(size["length"]);
  p.width = EstimateFrom(size["width"]);
  p.height = EstimateFrom(size["height"]);
  p.mass = EstimateFrom(field["mass_kg"]);
  p.material = field["material"]["name"].Text();
  p.density = EstimateFrom(field["material"]["density_kg_m3"]);
  p.friction = EstimateFrom(field["friction"]);
  p.restitution = EstimateFrom(field["restitution"]);
  if (field.Has("interval_90")) p.intervals = IntervalsFrom(field["interval_90"]);
  return p;
}

}  // namespace simwright::assets
