#include "asset_looks/asset_surfaces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/pbr_look.h"
#include "core/error.h"
#include "core/parallel.h"
#include "texture/uv_atlas.h"

namespace simwright::asset_looks {
namespace fs = std::filesystem;
namespace {

constexpr int kLeastLinkSize = 128, kLargestAtlas = 4096;

// Collects slots; equal ones are kept once.
class SlotList {
 public:
  explicit SlotList(std::vector<LookSlot>* slots) : slots_(slots) {}

  int Find(const LookSlot& slot) {
    const auto key = std::make_tuple(slot.material, slot.part, slot.substance);
    const auto [at, is_new] = known_.try_emplace(key, static_cast<int>(slots_->size()));
    if (is_new) slots_->push_back(slot);
    return at->second;
  }

 private:
  std::vector<LookSlot>* slots_;
  std::map<std::tuple<std::string, std::string, std::string>, int> known_;
};

// Gives the mesh coordinates of its own if those it has are none.
void MakeUnique(const std::string& place, TexturedSurface* surface, core::Findings* findings) {
  core::TexturedMesh& mesh = surface->mesh;
  if (texture::UvsAreUnique(mesh.mesh, mesh.corner_uvs)) return;
  const bool had_any = !mesh.corner_uvs.empty();
  mesh.corner_uvs.clear();
  texture::AtlasOptions atlas;
  atlas.size = surface->size;
  while (mesh.corner_uvs.empty()) {
    try {
      mesh.corner_uvs = texture::UnwrapToAtlas(mesh.mesh, atlas);
    } catch (const core::Error&) {
      if (atlas.size >= kLargestAtlas) throw;
      atlas.size *= 2;
    }
  }
  surface->size = atlas.size;
  if (had_any) {
    findings->push_back({"texture-new-atlas", core::Severity::kInfo, place,
                         "the texture coordinates overlap or repeat, and a new atlas replaces them",
                         static_cast<double>(atlas.size)});
  }
}

TexturedSurface SurfaceOf(const core::TexturedMesh& visual, int size, const std::string& part,
                          const std::string& substance, SlotList* slots) {
  TexturedSurface surface;
  surface.mesh = visual;
  surface.size = size;
  std::vector<int> slot_of_material;
  std::vector<bool> is_used(visual.materials.size(), visual.triangle_material.empty());
  for (const int material : visual.triangle_material) {
    is_used[static_cast<std::size_t>(material)] = true;
  }
  for (std::size_t m = 0; m < visual.materials.size(); ++m) {
    const core::Material& material = visual.materials[m];
    if (!is_used[m]) {
      slot_of_material.push_back(-1);
      continue;
    }
    LookSlot slot;
    slot.material = PlainWords(material.name);
    slot.part = part;
    slot.substance = substance;
    slot.color = material.base_color.head<3>();
    slot_of_material.push_back(slots->Find(slot));
  }
  if (slot_of_material.empty()) slot_of_material.push_back(slots->Find({"", part, substance}));
  for (std::size_t t = 0; t < visual.mesh.triangles.size(); ++t) {
    const int material = visual.triangle_material.empty() ? 0 : visual.triangle_material[t];
    surface.triangle_slot.push_back(slot_of_material[static_cast<std::size_t>(material)]);
  }
  return surface;
}

// Returns the side of a link's texture, a power of two, at about one density for all links.
int LinkSize(double area, double total, int size) {
  const double side = size * std::sqrt(area / std::max(1e-12, total));
  const int rounded = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(1.0, side))));
  return std::clamp(rounded, std::min(kLeastLinkSize, size), size);
}

void AddRigid(const fs::path& folder, int size, AssetSurfaces* result) {
  result->rigid = assets::ReadAsset(folder);
  result->look = assets::ReadPbrLook(folder);
  const assets::Asset& asset = *result->rigid;
  result->name = asset.name;
  result->category = asset.parameters.category;
  SlotList slots(&result->slots);
  result->surfaces.push_back(SurfaceOf(asset.visual, size, "", asset.parameters.material, &slots));
  MakeUnique(asset.name, &result->surfaces.back(), &result->findings);
}

void AddArticulated(const fs::path& folder, int size, AssetSurfaces* result) {
  result->articulated = assets::ReadArticulatedAsset(folder);
  const assets::ArticulatedAsset& asset = *result->articulated;
  result->name = asset.name;
  result->category = asset.parameters.category;
  double total = 0.0;
  for (const assets::ArticulatedLink& link : asset.links) {
    total += core::SurfaceArea(link.visual.mesh);
  }
  SlotList slots(&result->slots);
  for (const assets::ArticulatedLink& link : asset.links) {
    const int own = LinkSize(core::SurfaceArea(link.visual.mesh), total, size);
    result->surfaces.push_back(SurfaceOf(link.visual, own, link.label, link.material, &slots));
    if (link.visual.mesh.empty()) continue;
    MakeUnique(asset.name + "/" + link.name, &result->surfaces.back(), &result->findings);
  }
}

// Adds up the areas of the slots, and of the handles of those that are round.
void MeasureSlots(AssetSurfaces* asset) {
  asset->handle_area.assign(asset->slots.size(), 0.0);
  for (const TexturedSurface& surface : asset->surfaces) {
    const core::TriangleMesh& mesh = surface.mesh.mesh;
    for (std::size_t t = 0; t < surface.triangle_slot.size(); ++t) {
      const std::size_t slot = static_cast<std::size_t>(surface.triangle_slot[t]);
      const double area = 0.5 * core::TriangleAreaVector(mesh, static_cast<int>(t)).norm();
      asset->slots[slot].area += area;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) middle += mesh.vertices[mesh.triangles[t][k]] / 3.0;
      if (texture::IsOnHandle(surface.slot_frames[slot], middle.cast<float>())) {
        asset->handle_area[slot] += area;
      }
    }
  }
}

}  // namespace

AssetSurfaces ReadAssetSurfaces(const fs::path& folder, int size) {
  if (!assets::IsAssetFolder(folder)) {
    throw core::Error("holds no asset.json", folder.string(),
                      "give a folder made by `simwright lift`, `import` or `library`");
  }
  AssetSurfaces result;
  const bool articulated = assets::IsArticulatedAssetFolder(folder);
  (articulated ? AddArticulated : AddRigid)(folder, size, &result);
  const int slots = static_cast<int>(result.slots.size());
  core::ParallelFor(static_cast<int>(result.surfaces.size()), [&](int i) {
    TexturedSurface& surface = result.surfaces[static_cast<std::size_t>(i)];
    const core::TriangleMesh& mesh = surface.mesh.mesh;
    if (mesh.empty()) return;
    surface.map = texture::MakeTexelMap(mesh, surface.mesh.corner_uvs, surface.size);
    surface.pieces = texture::FramesOfPieces(mesh, surface.triangle_slot);
    // Boards of different links come from different places of the tree.
    for (texture::PartFrame& frame : surface.pieces.frames) {
      frame.seed += 0x9e3779b9u * static_cast<std::uint32_t>(i);
    }
    surface.slot_frames = texture::FramesOfLabels(mesh, surface.triangle_slot, slots);
  });
  MeasureSlots(&result);
  return result;
}

}  // namespace simwright::asset_looks
