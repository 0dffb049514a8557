#include "assets/asset_folder.h"

#include <algorithm>

#include "assets/asset_json.h"
#include "assets/mesh_import.h"
#include "assets/mjcf_scene.h"
#include "assets/model_writer.h"
#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"
#include "core/log.h"

namespace simwright::assets {
namespace {

Json RigidJson(const Asset& a) {
  Json json;
  json["format"] = kFormatVersion;
  json["name"] = a.name;
  json["source"] = a.source;
  json["seed"] = a.seed;
  json.update(ToJson(a.parameters));
  const Eigen::AlignedBox3d box = core::Bounds(a.visual.mesh);
  json["bounds_m"] = {{"min", ToJson(Eigen::Vector3d(box.min()))},
                      {"max", ToJson(Eigen::Vector3d(box.max()))}};
  json["rolling_friction_m"] = a.rolling_friction;
  json.update(ToJson(a.inertial));
  json["volume_m3"] = a.volume;
  json["density_kg_m3"] = a.density;
  json["wall_thickness_m"] = a.wall_thickness;
  json["wall_on_surface"] = a.wall_on_surface;
  json["mass_reconciled"] = a.mass_sentence;
  json["solid"] = {{"method", a.solid_method},
                   {"watertight", true},
                   {"faces", a.solid.triangles.size()},
                   {"sheet_thickness_m", a.sheet_thickness}};
  json["parts"] = {{"count", a.parts.size()}, {"concavity", a.concavity}, {"coverage", a.coverage}};
  json["link_from_input"] = ToJson(a.link_from_input);
  json["link_from_input"]["scale"] = a.scale;
  json["rolls"] = a.rolls;
  json["findings"] = ToJson(a.findings);
  json["versions"] = {{"simwright", SIMWRIGHT_VERSION}};
  return json;
}

Asset AssetFrom(const Json& json, const std::string& where) {
  if (json.value("articulated", false)) {
    throw core::Error("has joints and is not a single body", where,
                      "read it as an articulated asset");
  }
  Asset a;
  a.name = json.at("name");
  a.parameters = ParametersFrom(json);
  a.friction = a.parameters.friction.sample;
  a.restitution = a.parameters.restitution.sample;
  a.rolling_friction = json.at("rolling_friction_m");
  a.source = json.at("source");
  a.seed = json.at("seed");
  a.inertial = InertialFrom(json);
  a.volume = json.at("volume_m3");
  a.density = json.at("density_kg_m3");
  a.wall_thickness = json.at("wall_thickness_m");
  a.wall_on_surface = json.value("wall_on_surface", a.wall_thickness > 0.0);
  a.mass_sentence = json.at("mass_reconciled");
  a.solid_method = json.at("solid").at("method");
  a.sheet_thickness = json.at("solid").at("sheet_thickness_m");
  a.concavity = json.at("parts").at("concavity");
  a.coverage = json.at("parts").at("coverage");
  const Json& turn = json.at("link_from_input");
  a.scale = turn.at("scale");
  a.link_from_input = PoseFrom(turn);
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
  core::WriteFile(folder / MjcfSceneFileName(asset.name),
                  MjcfSceneText(asset.name, static_cast<int>(asset.parts.size()),
                                core::Bounds(asset.visual.mesh)));
  core::WriteFile(folder / (asset.name + ".sdf"), SdfText(asset));
  core::WriteFile(folder / "asset.json", RigidJson(asset).dump(2) + "\n");
  core::Log(core::LogLevel::kInfo, "assets", "wrote ", folder, ": ", asset.parts.size(),
            " collision parts, ", asset.inertial.mass, " kg");
}

void AddFindings(const std::filesystem::path& folder, const core::Findings& findings) {
  if (findings.empty()) return;
  const std::filesystem::path file = folder / "asset.json";
  Json json;
  try {
    json = Json::parse(core::ReadFile(file, 16 << 20));
    Json& known = json.at("findings");
    for (const Json& finding : ToJson(findings)) {
      if (std::find(known.begin(), known.end(), finding) == known.end()) known.push_back(finding);
    }
  } catch (const nlohmann::json::exception& error) {
    throw core::Error(std::string("is not a valid asset description: ") + error.what(),
                      file.string(), "make the asset again");
  }
  core::WriteFile(file, json.dump(2) + "\n");
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
    asset = AssetFrom(json, file.string());
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
  core::Log(core::LogLevel::kInfo, "assets", "read ", folder, ": ", asset.parts.size(),
            " collision parts, ", asset.inertial.mass, " kg");
  return asset;
}

}  // namespace simwright::assets
