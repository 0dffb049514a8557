#include "assets/asset_folder.h"

#include <algorithm>

#include "assets/asset_json.h"
#include "assets/mesh_import.h"
#include "assets/mjcf_scene.h"
#include "assets/model_writer.h"
#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/log.h"

namespace simwright::assets {
namespace {

core::OrderedJson RigidJson(const Asset& a) {
  core::OrderedJson json;
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
  json["findings"] = core::StoredFindingsJson(a.findings);
  json["versions"] = {{"simwright", SIMWRIGHT_VERSION}};
  return json;
}

Asset AssetFrom(const core::JsonField& field, const std::string& where) {
  if (field.FlagOr("articulated", false)) {
    throw core::Error("has joints and is not a single body", where,
                      "read it as an articulated asset");
  }
  Asset a;
  a.name = field["name"].Text();
  a.parameters = ParametersFrom(field);
  a.friction = a.parameters.friction.sample;
  a.restitution = a.parameters.restitution.sample;
  a.rolling_friction = field["rolling_friction_m"].Number();
  a.source = field["source"].Text();
  a.seed = field["seed"].Unsigned();
  a.inertial = InertialFrom(field);
  a.volume = field["volume_m3"].Number();
  a.density = field["density_kg_m3"].Number();
  a.wall_thickness = field["wall_thickness_m"].Number();
  a.wall_on_surface = field.FlagOr("wall_on_surface", a.wall_thickness > 0.0);
  a.mass_sentence = field["mass_reconciled"].Text();
  a.solid_method = field["solid"]["method"].Text();
  a.sheet_thickness = field["solid"]["sheet_thickness_m"].Number();
  a.concavity = field["parts"]["concavity"].Number();
  a.coverage = field["parts"]["coverage"].Number();
  a.scale = field["link_from_input"]["scale"].Number();
  a.link_from_input = PoseFrom(field["link_from_input"]);
  a.rolls = field["rolls"].Flag();
  if (field.Has("findings")) a.findings = core::FindingsFrom(field["findings"]);
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
  core::WriteFile(folder / "asset.json",
                  core::JsonText(RigidJson(asset), core::InvalidUtf8::kReplace));
  core::Log(core::LogLevel::kInfo, "assets", "wrote ", folder, ": ", asset.parts.size(),
            " collision parts, ", asset.inertial.mass, " kg");
}

void AddFindings(const std::filesystem::path& folder, const core::Findings& findings) {
  if (findings.empty()) return;
  const std::filesystem::path file = folder / "asset.json";
  core::OrderedJson json =
      core::ParseOrderedJson(core::ReadFile(file, kMaxAssetJsonBytes), file.string(), kAssetRemedy);
  if (!json.is_object() || !json.contains("findings") || !json["findings"].is_array()) {
    throw core::Error("'findings' is missing or is not an array", file.string(), kAssetRemedy);
  }
  core::OrderedJson& known = json["findings"];
  for (const core::OrderedJson& finding : core::StoredFindingsJson(findings)) {
    if (std::find(known.begin(), known.end(), finding) == known.end()) known.push_back(finding);
  }
  core::WriteFile(file, core::JsonText(json, core::InvalidUtf8::kReplace));
}

Asset ReadAsset(const std::filesystem::path& folder) {
  const core::JsonDocument document = ReadAssetJson(folder);
  Asset asset = AssetFrom(document.root(), document.file());
  if (FileSafeName(asset.name) != asset.name) {
    throw InvalidName(asset.name, document.file());
  }
  const int parts = document.root()["parts"]["count"].Int(0, kMaxParts);
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
