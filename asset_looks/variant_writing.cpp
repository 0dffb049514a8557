#include "asset_looks/variant_writing.h"

#include <cstdio>
#include <set>
#include <utility>

#include "asset_build/articulated_preview.h"
#include "asset_build/preview.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/pbr_look.h"
#include "core/error.h"
#include "core/files.h"
#include "core/pbr_look.h"
#include "render/turntable.h"

namespace simwright::asset_looks {
namespace fs = std::filesystem;
namespace {

constexpr int kViewSize = 360;  // pixels per side
constexpr std::uint64_t kMaxJsonBytes = 256ull << 20;

core::TexturedMesh WithTexture(const TexturedSurface& surface, const core::Image& texture) {
  core::TexturedMesh mesh = surface.mesh;
  if (mesh.mesh.empty()) return mesh;
  mesh.textures = {texture};
  mesh.materials = {{"painted", Eigen::Vector4f::Ones(), 0}};
  mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  return mesh;
}

core::PbrLook LookOf(const texture::MaterialMaps& maps) {
  core::PbrLook look;
  core::PbrMaterial material;
  material.roughness = 1.0f;
  material.roughness_map = 0;
  look.images.push_back(maps.roughness);
  material.normal_map = 1;
  look.images.push_back(maps.normal);
  if (maps.any_metal) {
    material.metallic = 1.0f;
    material.metallic_map = 2;
    look.images.push_back(maps.metallic);
  }
  look.materials.push_back(material);
  return look;
}

core::Image RigidViewOf(const assets::Asset& asset, const core::PbrLook& look) {
  render::TurntableOptions options;
  options.views = 1;
  options.size = kViewSize;
  if (!look.empty()) options.look = &look;
  return render::Turntable(asset.visual, options).front();
}

core::OrderedJson ReadJson(const fs::path& file) {
  return core::ParseOrderedJson(core::ReadFile(file, kMaxJsonBytes), file.string());
}

// Prompts and names may contain invalid UTF-8.
void WriteJson(const fs::path& file, const core::OrderedJson& json) {
  core::WriteFile(file, core::JsonText(json, core::InvalidUtf8::kReplace));
}

// Copies what the writer of assets knows nothing of: grasps, certificates, members of asset.json.
void CopyTheRest(const fs::path& source, const fs::path& folder, const core::OrderedJson& record) {
  static const std::set<std::string> kLooks = {"materials", "appearances", "texture"};
  core::OrderedJson json = ReadJson(folder / "asset.json");
  const core::OrderedJson former = ReadJson(source / "asset.json");
  for (const auto& [key, value] : former.items()) {
    if (!json.contains(key) && !kLooks.contains(key)) json[key] = value;
  }
  json["texture"] = record;
  WriteJson(folder / "asset.json", json);
  for (const auto& entry : fs::directory_iterator(source)) {
    const std::string name = entry.path().filename().string();
    const bool is_grasp = name.starts_with("grasps");
    if (!entry.is_regular_file() || !is_grasp || fs::exists(folder / name)) continue;
    fs::copy_file(entry.path(), folder / name);
  }
}

std::string AppearanceName(std::size_t index, const char* role) {
  char name[48];
  std::snprintf(name, sizeof name, "appearance_%03zu_%s.png", index, role);
  return name;
}

}  // namespace

assets::Asset TexturedRigid(const AssetSurfaces& asset, const texture::MaterialMaps& maps,
                            const std::string& name) {
  assets::Asset textured = *asset.rigid;
  textured.name = name;
  textured.visual = WithTexture(asset.surfaces.front(), maps.color);
  return textured;
}

assets::ArticulatedAsset TexturedArticulated(const AssetSurfaces& asset,
                                             const std::vector<texture::MaterialMaps>& maps,
                                             const std::string& name) {
  assets::ArticulatedAsset textured = *asset.articulated;
  textured.name = name;
  for (std::size_t i = 0; i < textured.links.size(); ++i) {
    textured.links[i].visual = WithTexture(asset.surfaces[i], maps[i].color);
  }
  return textured;
}

core::Image WriteVariant(const AssetSurfaces& asset, const std::vector<texture::MaterialMaps>& maps,
                         const std::string& name, const core::OrderedJson& record,
                         const fs::path& source, const fs::path& folder) {
  core::Image view;
  if (asset.rigid) {
    const assets::Asset textured = TexturedRigid(asset, maps.front(), name);
    assets::WriteAsset(textured, folder);
    const core::PbrLook look = LookOf(maps.front());
    assets::AddPbrLook(textured.visual, look, name, folder);
    core::WritePng(folder / "preview.png", asset_build::AssetPreview(textured, &look));
    view = RigidViewOf(textured, look);
  } else {
    const assets::ArticulatedAsset textured = TexturedArticulated(asset, maps, name);
    assets::WriteArticulatedAsset(textured, folder);
    core::WritePng(folder / "preview.png", asset_build::ArticulatedPreview(textured));
    view = asset_build::ArticulatedView(textured, 0.3, kViewSize);
  }
  CopyTheRest(source, folder, record);
  return view;
}

core::OrderedJson WriteAppearance(const texture::MaterialMaps& maps, std::size_t index,
                                  const core::OrderedJson& record, const fs::path& folder) {
  core::OrderedJson entry;
  const auto write = [&](const char* role, const core::Image& image) {
    const std::string file = AppearanceName(index, role);
    core::WritePng(folder / file, image);
    entry[std::string(role) + "_map"] = file;
  };
  write("base_color", maps.color);
  write("roughness", maps.roughness);
  write("normal", maps.normal);
  if (maps.any_metal) write("metallic", maps.metallic);
  entry["texture"] = record;
  return entry;
}

void AddAppearances(const std::vector<core::OrderedJson>& entries, const fs::path& folder) {
  core::OrderedJson json = ReadJson(folder / "asset.json");
  json["appearances"] = entries;
  WriteJson(folder / "asset.json", json);
}

core::Image ViewOf(const AssetSurfaces& asset, const texture::MaterialMaps* maps) {
  if (asset.rigid && maps != nullptr) {
    return RigidViewOf(TexturedRigid(asset, *maps, asset.name), LookOf(*maps));
  }
  if (asset.rigid) return RigidViewOf(*asset.rigid, asset.look);
  return asset_build::ArticulatedView(*asset.articulated, 0.3, kViewSize);
}

}  // namespace simwright::asset_looks
