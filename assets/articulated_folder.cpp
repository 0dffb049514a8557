#include "assets/articulated_folder.h"

#include "assets/articulated_sdf.h"
#include "assets/articulated_writer.h"
#include "assets/asset_json.h"
#include "assets/mesh_import.h"
#include "assets/mjcf_scene.h"
#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/log.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

core::OrderedJson LinkJson(const ArticulatedLink& link) {
  core::OrderedJson json;
  json["name"] = link.name;
  json["label"] = link.label;
  json["material"] = link.material;
  json["friction"] = link.friction;
  json["restitution"] = link.restitution;
  json.update(ToJson(link.inertial));
  json["volume_m3"] = link.volume;
  json["parts"] = link.parts.size();
  json["densities_kg_m3"] = link.densities;
  json["visuals"] = core::OrderedJson::array();
  for (const ColoredPiece& piece : ColoredPieces(link)) {
    json["visuals"].push_back(piece.stem + ".obj");
  }
  return json;
}

core::OrderedJson JointJson(const Joint& joint) {
  core::OrderedJson json;
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

core::OrderedJson ArticulatedJson(const ArticulatedAsset& a) {
  core::OrderedJson json;
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
  json["links"] = core::OrderedJson::array();
  for (const ArticulatedLink& link : a.links) json["links"].push_back(LinkJson(link));
  json["joints"] = core::OrderedJson::array();
  for (const Joint& joint : a.joints) json["joints"].push_back(JointJson(joint));
  if (!a.excluded_pairs.empty()) json["excluded_pairs"] = a.excluded_pairs;
  json["findings"] = core::StoredFindingsJson(a.findings);
  json["versions"] = {{"simwright", SIMWRIGHT_VERSION}};
  return json;
}

Joint JointFrom(const core::JsonField& field) {
  Joint joint;
  joint.name = field["name"].Text();
  joint.type = JointTypeNamed(field["type"].Text());
  joint.parent = field["parent"].Text();
  joint.child = field["child"].Text();
  joint.parent_from_joint = PoseFrom(field["parent_from_joint"]);
  joint.axis = field["axis"].Vector<3>();
  joint.lower = field["lower"].Number();
  joint.upper = field["upper"].Number();
  joint.damping = field["damping"].Number();
  joint.friction = field["friction"].Number();
  joint.effort = field["effort"].Number();
  joint.velocity = field["velocity"].Number();
  return joint;
}

core::TexturedMesh VisualFrom(const core::JsonField& files, const fs::path& folder) {
  core::TexturedMesh visual;
  for (const std::string& file : files.Texts()) {
    core::TexturedMesh piece = ReadMesh(core::ResolveInside(folder, file));
    piece.triangle_material.assign(piece.mesh.triangles.size(), 0);
    piece.materials = {piece.materials.empty() ? core::Material{} : piece.materials.back()};
    piece.part_names.clear();
    piece.triangle_part.clear();
    AppendVisual(piece, &visual);
  }
  return visual;
}

ArticulatedLink LinkFrom(const core::JsonField& field, const fs::path& folder) {
  ArticulatedLink link;
  link.name = field["name"].Text();
  if (FileSafeName(link.name) != link.name) field["name"].Fail("is not a valid name of a link");
  link.label = field["label"].Text();
  link.material = field["material"].Text();
  link.friction = field["friction"].Number();
  link.restitution = field["restitution"].Number();
  link.inertial = InertialFrom(field);
  link.volume = field["volume_m3"].Number();
  const int parts = field["parts"].Int(0, kMaxParts);
  link.densities = field["densities_kg_m3"].Numbers(static_cast<size_t>(parts));
  for (int i = 0; i < parts; ++i) {
    link.parts.push_back(ReadBareObj(folder / LinkCollisionFileName(link.name, i)));
  }
  link.visual = VisualFrom(field["visuals"], folder);
  return link;
}

std::vector<ExcludedPair> ExcludedPairsFrom(const core::JsonField& field) {
  std::vector<ExcludedPair> pairs;
  for (const core::JsonField& pair : field.Elements()) {
    const std::vector<core::JsonField> names = pair.Elements(2);
    pairs.emplace_back(names[0].Text(), names[1].Text());
  }
  return pairs;
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
      WriteVisual(piece.mesh, folder, piece.stem, piece.texture);
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
  core::WriteFile(folder / "asset.json",
                  core::JsonText(ArticulatedJson(asset), core::InvalidUtf8::kReplace));
  core::Log(core::LogLevel::kInfo, "assets", "wrote ", folder, ": ", asset.links.size(), " links, ",
            parts, " collision parts");
}

bool IsArticulatedAssetFolder(const fs::path& folder) {
  if (!fs::is_regular_file(folder / "asset.json")) return false;
  const auto json = core::TryParseJson(core::ReadFile(folder / "asset.json", kMaxAssetJsonBytes));
  const core::Json* articulated = json ? core::FindMember(*json, "articulated") : nullptr;
  return articulated != nullptr && articulated->is_boolean() && articulated->get<bool>();
}

ArticulatedAsset ReadArticulatedAsset(const fs::path& folder) {
  const core::JsonDocument document = ReadAssetJson(folder);
  const core::JsonField root = document.root();
  if (!root.FlagOr("articulated", false)) {
    throw core::Error("describes a rigid asset", document.file(), "use an articulated one");
  }
  ArticulatedAsset asset;
  asset.name = root["name"].Text();
  if (FileSafeName(asset.name) != asset.name) {
    throw InvalidName(asset.name, document.file());
  }
  asset.source = root["source"].Text();
  asset.seed = root["seed"].Unsigned();
  asset.fixed = root["fixed"].Flag();
  asset.parameters = ParametersFrom(root);
  for (const auto& [name, feature] : root["features"].Members()) {
    asset.features[name] = feature.Text();
  }
  for (const core::JsonField& link : root["links"].Elements()) {
    asset.links.push_back(LinkFrom(link, folder));
  }
  for (const core::JsonField& joint : root["joints"].Elements()) {
    asset.joints.push_back(JointFrom(joint));
  }
  if (root.Has("excluded_pairs")) {
    asset.excluded_pairs = ExcludedPairsFrom(root["excluded_pairs"]);
  }
  asset.findings = core::FindingsFrom(root["findings"]);
  RequireLinkTree(asset, document.file());
  core::Log(core::LogLevel::kInfo, "assets", "read ", folder, ": ", asset.links.size(), " links");
  return asset;
}

}  // namespace simwright::assets
