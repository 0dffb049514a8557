#include "assets/articulated_folder.h"

#include "assets/articulated_sdf.h"
#include "assets/articulated_writer.h"
#include "assets/asset_json.h"
#include "assets/mesh_import.h"
#include "assets/mjcf_scene.h"
#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"
#include "core/log.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr int kMostParts = 10000;

Json LinkJson(const ArticulatedLink& link) {
  Json json;
  json["name"] = link.name;
  json["label"] = link.label;
  json["material"] = link.material;
  json["friction"] = link.friction;
  json["restitution"] = link.restitution;
  json.update(ToJson(link.inertial));
  json["volume_m3"] = link.volume;
  json["parts"] = link.parts.size();
  json["densities_kg_m3"] = link.densities;
  json["visuals"] = Json::array();
  for (const ColoredPiece& piece : ColoredPieces(link)) {
    json["visuals"].push_back(piece.stem + ".obj");
  }
  return json;
}

Json JointJson(const Joint& joint) {
  Json json;
  json["name"] = joint.name;
  json["type"] = JointTypeName(joint.type);
  json["parent"] = joint.parent;
  json["child"] = joint.child;
  json["parent_from_joint"] = ToJson(joint.parent_from_joint);
  json["axis"] = ToJson(joint.axis);
  json["lower"] = joint.lower;
  json["upper"] = joint.upper;
  json["damping"] = joint.damping;
  json["friction"] = joint.friction;
  json["effort"] = joint.effort;
  json["velocity"] = joint.velocity;
  return json;
}

Json ArticulatedJson(const ArticulatedAsset& a) {
  Json json;
  json["format"] = kFormatVersion;
  json["articulated"] = true;
  json["name"] = a.name;
  json["source"] = a.source;
  json["seed"] = a.seed;
  json["fixed"] = a.fixed;
  json.update(ToJson(a.parameters));
  const Eigen::AlignedBox3d box = BoundsAtZero(a);
  json["bounds_m"] = {{"min", ToJson(Eigen::Vector3d(box.min()))},
                      {"max", ToJson(Eigen::Vector3d(box.max()))}};
  json.update(ToJson(CombinedInertial(ModelOf(a))));
  json["features"] = a.features;
  json["links"] = Json::array();
  for (const ArticulatedLink& link : a.links) json["links"].push_back(LinkJson(link));
  json["joints"] = Json::array();
  for (const Joint& joint : a.joints) json["joints"].push_back(JointJson(joint));
  if (!a.excluded_pairs.empty()) json["excluded_pairs"] = a.excluded_pairs;
  json["findings"] = ToJson(a.findings);
  json["versions"] = {{"simwright", SIMWRIGHT_VERSION}};
  return json;
}

Joint JointFrom(const Json& json) {
  Joint joint;
  joint.name = json.at("name");
  joint.type = JointTypeNamed(json.at("type"));
  joint.parent = json.at("parent");
  joint.child = json.at("child");
  joint.parent_from_joint = PoseFrom(json.at("parent_from_joint"));
  joint.axis = VectorFrom(json.at("axis"));
  joint.lower = json.at("lower");
  joint.upper = json.at("upper");
  joint.damping = json.at("damping");
  joint.friction = json.at("friction");
  joint.effort = json.at("effort");
  joint.velocity = json.at("velocity");
  return joint;
}

core::TexturedMesh VisualFrom(const Json& files, const fs::path& folder) {
  core::TexturedMesh visual;
  for (const Json& file : files) {
    const core::TexturedMesh piece = ReadMesh(core::ResolveInside(folder, file.get<std::string>()));
    core::Append(piece.mesh, &visual.mesh);
    const int index = static_cast<int>(visual.materials.size());
    visual.triangle_material.resize(visual.mesh.triangles.size(), index);
    visual.materials.push_back(piece.materials.empty() ? core::Material{} : piece.materials.back());
  }
  return visual;
}

ArticulatedLink LinkFrom(const Json& json, const fs::path& folder) {
  ArticulatedLink link;
  link.name = json.at("name");
  link.label = json.at("label");
  link.material = json.at("material");
  link.friction = json.at("friction");
  link.restitution = json.at("restitution");
  link.inertial = InertialFrom(json);
  link.volume = json.at("volume_m3");
  const int parts = json.at("parts");
  if (FileSafeName(link.name) != link.name || parts < 0 || parts > kMostParts) {
    throw core::Error("names an invalid link", (folder / "asset.json").string(),
                      "make the asset again");
  }
  link.densities = json.at("densities_kg_m3").get<std::vector<double>>();
  if (link.densities.size() != static_cast<size_t>(parts)) {
    throw core::Error("does not have one density per part", (folder / "asset.json").string(),
                      "make the asset again");
  }
  for (int i = 0; i < parts; ++i) {
    link.parts.push_back(ReadBareObj(folder / LinkCollisionFileName(link.name, i)));
  }
  link.visual = VisualFrom(json.at("visuals"), folder);
  return link;
}

// Requires that joint i connects an earlier link to link i + 1.
void RequireLinkTree(const ArticulatedAsset& asset, const std::string& where) {
  bool tree = !asset.links.empty() && asset.joints.size() + 1 == asset.links.size();
  for (size_t i = 0; tree && i < asset.joints.size(); ++i) {
    bool known = false;
    for (size_t k = 0; k <= i; ++k) known |= asset.links[k].name == asset.joints[i].parent;
    tree = known && asset.joints[i].child == asset.links[i + 1].name;
  }
  if (!tree) {
    throw core::Error("its joints and links do not make a tree", where, "make the asset again");
  }
}

}  // namespace

void WriteArticulatedAsset(const ArticulatedAsset& asset, const fs::path& folder) {
  for (const ArticulatedLink& link : asset.links) {
    for (const ColoredPiece& piece : ColoredPieces(link)) {
      WriteVisual(piece.mesh, folder, piece.stem);
    }
    for (size_t i = 0; i < link.parts.size(); ++i) {
      core::WriteFile(folder / LinkCollisionFileName(link.name, static_cast<int>(i)),
                      ObjText(link.parts[i]));
    }
  }
  core::WriteFile(folder / (asset.name + ".urdf"), ArticulatedUrdfText(asset));
  core::WriteFile(folder / (asset.name + ".xml"), ArticulatedMjcfText(asset));
  int parts = 0;
  for (const ArticulatedLink& link : asset.links) parts += static_cast<int>(link.parts.size());
  core::WriteFile(folder / MjcfSceneFileName(asset.name),
                  MjcfSceneText(asset.name, parts, BoundsAtZero(asset)));
  core::WriteFile(folder / (asset.name + ".sdf"), ArticulatedSdfText(asset));
  core::WriteFile(folder / "semantics.txt", SemanticsText(asset));
  core::WriteFile(folder / "asset.json", ArticulatedJson(asset).dump(2) + "\n");
  core::Log(core::LogLevel::kInfo, "assets", "wrote ", folder, ": ", asset.links.size(), " links, ",
            parts, " collision parts");
}

bool IsArticulatedAssetFolder(const fs::path& folder) {
  if (!fs::is_regular_file(folder / "asset.json")) return false;
  const Json json = Json::parse(core::ReadFile(folder / "asset.json", 16 << 20), nullptr, false);
  const auto found = json.is_object() ? json.find("articulated") : json.end();
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

ArticulatedAsset ReadArticulatedAsset(const fs::path& folder) {
  const fs::path file = folder / "asset.json";
  ArticulatedAsset asset;
  try {
    const Json json = Json::parse(core::ReadFile(file, 16 << 20));
    if (json.at("format").get<int>() > kFormatVersion) {
      throw core::Error("was written by a newer version", file.string(), "update simwright");
    }
    if (!json.value("articulated", false)) {
      throw core::Error("describes a rigid asset", file.string(), "use an articulated one");
    }
    asset.name = json.at("name");
    if (FileSafeName(asset.name) != asset.name) {
      throw core::Error("names no asset", file.string(), "make the asset again");
    }
    asset.source = json.at("source");
    asset.seed = json.at("seed");
    asset.fixed = json.at("fixed");
    asset.parameters = ParametersFrom(json);
    asset.features = json.at("features").get<std::map<std::string, std::string>>();
    for (const Json& link : json.at("links")) asset.links.push_back(LinkFrom(link, folder));
    for (const Json& joint : json.at("joints")) asset.joints.push_back(JointFrom(joint));
    asset.excluded_pairs = json.value("excluded_pairs", std::vector<ExcludedPair>());
    asset.findings = FindingsFrom(json.at("findings"));
  } catch (const nlohmann::json::exception& error) {
    throw core::Error(std::string("is not a valid asset description: ") + error.what(),
                      file.string(), "make the asset again");
  }
  RequireLinkTree(asset, file.string());
  core::Log(core::LogLevel::kInfo, "assets", "read ", folder, ": ", asset.links.size(), " links");
  return asset;
}

}  // namespace simwright::assets
