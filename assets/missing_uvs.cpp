#include "assets/missing_uvs.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace simwright::assets {
namespace {

// Returns the mean of an image's colours, sRGB in [0, 1].
Eigen::Vector3f MeanColor(const core::Image& image) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int k = 0; k < 3; ++k) sum[k] += image.At(x, y)[image.channels < 3 ? 0 : k];
    }
  }
  const double pixels = std::max(1.0, static_cast<double>(image.width) * image.height);
  return (sum / (255.0 * pixels)).cast<float>();
}

// Removes the textures that no material uses.
void DropUnusedTextures(core::TexturedMesh* mesh) {
  std::vector<int> index(mesh->textures.size(), -1);
  std::vector<core::Image> used;
  for (core::Material& material : mesh->materials) {
    if (material.texture < 0) continue;
    int& at = index[static_cast<size_t>(material.texture)];
    if (at < 0) {
      at = static_cast<int>(used.size());
      used.push_back(std::move(mesh->textures[static_cast<size_t>(material.texture)]));
    }
    material.texture = at;
  }
  mesh->textures = std::move(used);
}

void SayPartly(const core::Material& material, size_t lacking, size_t all, FindingList* findings) {
  findings->Add(core::Severity::kWarning, "texture-without-uvs",
                std::to_string(lacking) + " of " + std::to_string(all) + " faces of material '" +
                    material.name + "' have no texture coordinates: they show one pixel of it",
                "unwrap them in a modeller (Blender: UV, Smart UV Project)",
                static_cast<double>(lacking));
}

}  // namespace

void DropTexturesWithoutUvs(RawMesh* raw, FindingList* findings) {
  core::TexturedMesh& mesh = raw->mesh;
  std::vector<size_t> faces(mesh.materials.size(), 0);
  for (const int material : mesh.triangle_material) {
    const size_t m = static_cast<size_t>(material);
    if (m < faces.size()) ++faces[m];  // others are refused by the reader's caller
  }
  bool dropped = false;
  for (const auto& [index, lacking] : raw->faces_without_uvs) {
    const size_t m = static_cast<size_t>(index);
    if (lacking == 0 || m >= mesh.materials.size()) continue;
    core::Material& material = mesh.materials[m];
    const bool maps = m < raw->look.materials.size() && raw->look.materials[m].HasMaps();
    if (material.texture < 0 && !maps) continue;
    if (lacking < faces[m]) {
      SayPartly(material, lacking, faces[m], findings);
      continue;
    }
    const bool textured = material.texture >= 0;
    if (textured) {
      const core::Image& texture = mesh.textures[static_cast<size_t>(material.texture)];
      material.base_color.head<3>().array() *= MeanColor(texture).array();
      material.texture = -1;
      dropped = true;
    }
    if (maps) {
      PbrMaterial& look = raw->look.materials[m];
      look.metallic_map = look.roughness_map = look.normal_map = -1;
    }
    findings->Add(core::Severity::kWarning, "texture-without-uvs",
                  "the faces of material '" + material.name + "' have no texture coordinates: " +
                      (textured ? "its texture cannot be placed, and its mean colour is used"
                                : "its maps cannot be placed and are left out"),
                  "unwrap the mesh in a modeller (Blender: UV, Smart UV Project)",
                  static_cast<double>(lacking));
  }
  if (dropped) DropUnusedTextures(&mesh);
}

}  // namespace simwright::assets
