#include "assets/asset_folder.h"

#include <nlohmann/json.hpp>

#include "assets/mesh_import.h"
#include "assets/model_writer.h"
#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormatVersion = 1;

Json ToJson(const physics_params::Estimate& e) {
  return {{"min", e.min}, {"max", e.max}, {"sample", e.sample}, {"source", e.source}};
}

physics_params::Estimate EstimateFrom(const Json& json) {
  return {json.at("min"), json.at("max"), json.at("sample"), json.at("source")};
}

Json ToJson(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json ToJson(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(ToJson(Eigen::Vector3d(m.row(row))));
  return rows;
}

Eigen::Vector3d VectorFrom(const Json& json) {
  return Eigen::Vector3d(json.at(0).get<double>(), json.at(1).get<double>(),
                         json.at(2).get<double>());
}

const char* SeverityName(core::Severity severity) {
  constexpr const char* kNames[] = {"info", "warning", "error"};
  return kNames[static_cast<int>(severity)];
}

Json ToJson(const core::Findings& findings) {
  Json list = Json::array();
  for (const core::Finding& f : findings) {
    list.push_back({{"code", f.code},
                    {"severity", SeverityName(f.severity)},
                    {"place", f.place},
                    {"sentence", f.sentence},
                    {"figure", f.figure}});
  }
  return list;
}

Json AssetJson(const Asset& a) {
  const auto& p = a.parameters;
  Json json;
  json["format"] = kFormatVersion;
  json["name"] = a.name;
  json["category"] = p.category;
  json["category_resolution"] = p.resolution;
  json["source"] = a.source;
  json["seed"] = a.seed;
  json["size_m"] = {
      {"length", ToJson(p.length)}, {"width", ToJson(p.width)}, {"height", ToJson(p.height)}};
  const Eigen::AlignedBox3d box = core::Bounds(a.visual.mesh);
  json["bounds_m"] = {{"min", ToJson(Eigen::Vector3d(box.min()))},
                      {"max", ToJson(Eigen::Vector3d(box.max()))}};
  json["mass_kg"] = ToJson(p.mass);
  json["material"] = {{"name", p.material},
                      {"fill", physics_params::FillName(p.fill)},
                      {"density_kg_m3", ToJson(p.density)}};
  json["friction"] = ToJson(p.friction);
  json["restitution"] = ToJson(p.restitution);
  json["rolling_friction_m"] = a.rolling_friction;
  json["mass"] = a.inertial.mass;
  json["center_of_mass"] = ToJson(a.inertial.center_of_mass);
  json["inertia"] = ToJson(a.inertial.inertia);
  json["volume_m3"] = a.volume;
  json["density_kg_m3"] = a.density;
  json["wall_thickness_m"] = a.wall_thickness;
  json["mass_reconciled"] = a.mass_sentence;
  json["solid"] = {{"method", a.solid_method},
                   {"watertight", true},
                   {"faces", a.solid.triangles.size()},
                   {"sheet_thickness_m", a.sheet_thickness}};
  json["parts"] = {{"count", a.parts.size()}, {"concavity", a.concavity}, {"coverage", a.coverage}};
  const Eigen::Quaterniond q(a.link_from_input.linear());
  json["link_from_input"] = {
      {"scale", a.scale},
      {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
      {"translation", ToJson(Eigen::Vector3d(a.link_from_input.translation()))}};
  json["rolls"] = a.rolls;
  json["findings"] = ToJson(a.findings);
  json["versions"] = {{"simwright", SIMWRIGHT_VERSION}};
  return json;
}

Asset AssetFrom(const Json& json) {
  Asset a;
  a.name = json.at("name");
  auto& p = a.parameters;
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
  a.friction = p.friction.sample;
  a.restitution = p.restitution.sample;
  a.rolling_friction = json.at("rolling_friction_m");
  a.source = json.at("source");
  a.seed = json.at("seed");
  a.inertial.mass = json.at("mass");
  a.inertial.center_of_mass = VectorFrom(json.at("center_of_mass"));
  for (int row = 0; row < 3; ++row) {
    a.inertial.inertia.row(row) = VectorFrom(json.at("inertia").at(row));
  }
  a.volume = json.at("volume_m3");
  a.density = json.at("density_kg_m3");
  a.wall_thickness = json.at("wall_thickness_m");
  a.mass_sentence = json.at("mass_reconciled");
  a.solid_method = json.at("solid").at("method");
  a.sheet_thickness = json.at("solid").at("sheet_thickness_m");
  a.concavity = json.at("parts").at("concavity");
  a.coverage = json.at("parts").at("coverage");
  const Json& turn = json.at("link_from_input");
  a.scale = turn.at("scale");
  const Json& q = turn.at("rotation_wxyz");
  a.link_from_input.linear() = Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(),
                                                  q.at(2).get<double>(), q.at(3).get<double>())
                                   .normalized()
                                   .toRotationMatrix();
  a.link_from_input.translation() = VectorFrom(turn.at("translation"));
  a.rolls = json.at("rolls");
  return a;
}

}  // namespace

bool IsAssetFolder(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(folder / "asset.json");
}

void WriteAsset(const Asset& asset, const std::filesystem::path& folder) {
  WriteVisual(asset.visual, folder);
  core::WriteFile(folder / "solid.obj", ObjText(asset.solid, true));
  for (size_t i = 0; i < asset.parts.size(); ++i) {
    core::WriteFile(folder / CollisionFileName(static_cast<int>(i)), ObjText(asset.parts[i]));
  }
  core::WriteFile(folder / (asset.name + ".urdf"), UrdfText(asset));
  core::WriteFile(folder / (asset.name + ".xml"), MjcfText(asset));
  core::WriteFile(folder / (asset.name + ".sdf"), SdfText(asset));
  core::WriteFile(folder / "asset.json", AssetJson(asset).dump(2) + "\n");
}

Asset ReadAsset(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "asset.json";
  Asset asset;
  int parts = 0;
  try {
    const Json json = Json::parse(core::ReadFile(file, 16 << 20));
    if (json.at("format").get<int>() > kFormatVersion) {
      throw core::Error("was written by a newer version", file.string(), "update simwright");
    }
    asset = AssetFrom(json);
    parts = json.at("parts").at("count");
  } catch (const nlohmann::json::exception& error) {
    throw core::Error(std::string("is not a valid asset description: ") + error.what(),
                      file.string(), "make the asset again");
  }
  if (FileSafeName(asset.name) != asset.name || parts < 0 || parts > 10000) {
    throw core::Error("is not a valid asset description", file.string(), "make the asset again");
  }
  asset.visual = ReadMesh(folder / "visual.obj");
  asset.solid = ReadBareObj(folder / "solid.obj");
  for (int i = 0; i < parts; ++i) {
    asset.parts.push_back(ReadBareObj(folder / CollisionFileName(i)));
  }
  return asset;
}

}  // namespace simwright::assets
