#include "assets/obj_file.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "assets/asset.h"
#include "core/files.h"

namespace simwright::assets {
namespace {

template <typename... Values>
void Print(std::string* text, const char* format, Values... values) {
  char line[160];
  const int length = std::snprintf(line, sizeof(line), format, values...);
  text->append(line, static_cast<size_t>(length));
}

// Returns file-safe, distinct names for the materials, in order.
std::vector<std::string> MaterialNames(const core::TexturedMesh& visual) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (size_t i = 0; i < visual.materials.size(); ++i) {
    std::string name = FileSafeName(visual.materials[i].name);
    if (!taken.insert(name).second) {
      name += "_" + std::to_string(i);
      taken.insert(name);
    }
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> TextureNames(const core::TexturedMesh& visual, const std::string& shared) {
  std::vector<std::string> names(visual.textures.size(), shared);
  const int count = static_cast<int>(names.size());
  for (int i = 0; i < count && shared.empty(); ++i) names[i] = TextureFileName(i, count);
  return names;
}

std::string MtlText(const core::TexturedMesh& visual, const std::vector<std::string>& names,
                    const std::vector<std::string>& textures) {
  std::string text;
  for (size_t i = 0; i < visual.materials.size(); ++i) {
    const core::Material& material = visual.materials[i];
    text += "newmtl " + names[i] + "\n";
    Print(&text, "Kd %.6g %.6g %.6g\n", material.base_color.x(), material.base_color.y(),
          material.base_color.z());
    Print(&text, "d %.6g\n", material.base_color.w());
    text += "illum 1\n";
    if (material.texture >= 0) {
      text += "map_Kd " + textures[static_cast<size_t>(material.texture)] + "\n";
    }
  }
  return text;
}

// Returns the triangles sorted by part, then material; the sort is stable.
std::vector<int> GroupedOrder(const core::TexturedMesh& visual) {
  std::vector<int> order(visual.mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int t) {
    return std::pair(visual.triangle_part.empty() ? 0 : visual.triangle_part[t],
                     visual.triangle_material.empty() ? 0 : visual.triangle_material[t]);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

std::string VisualObjText(const core::TexturedMesh& visual,
                          const std::vector<std::string>& material_names, const std::string& stem) {
  std::string text = "mtllib " + stem + ".mtl\n";
  text.reserve(visual.mesh.vertices.size() * 40 + visual.mesh.triangles.size() * 40);
  for (const Eigen::Vector3d& v : visual.mesh.vertices) {
    Print(&text, "v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
  }
  // Repeated UVs are shared, so that viewers can index them.
  std::map<std::pair<float, float>, int> uv_index;
  std::vector<int> corner_uv(visual.corner_uvs.size());
  for (size_t i = 0; i < visual.corner_uvs.size(); ++i) {
    const Eigen::Vector2f& uv = visual.corner_uvs[i];
    const auto [entry, fresh] =
        uv_index.try_emplace({uv.x(), uv.y()}, static_cast<int>(uv_index.size()) + 1);
    if (fresh) Print(&text, "vt %.7g %.7g\n", uv.x(), uv.y());
    corner_uv[i] = entry->second;
  }
  int part = -1, material = -1;
  for (const int t : GroupedOrder(visual)) {
    if (!visual.triangle_part.empty() && visual.triangle_part[t] != part) {
      part = visual.triangle_part[t];
      text += "o " + FileSafeName(visual.part_names[part]) + "\n";
    }
    if (!visual.triangle_material.empty() && visual.triangle_material[t] != material) {
      material = visual.triangle_material[t];
      text += "usemtl " + material_names[material] + "\n";
    }
    const Eigen::Vector3i f = visual.mesh.triangles[t] + Eigen::Vector3i::Ones();
    if (corner_uv.empty()) {
      Print(&text, "f %d %d %d\n", f[0], f[1], f[2]);
    } else {
      Print(&text, "f %d/%d %d/%d %d/%d\n", f[0], corner_uv[3 * t], f[1], corner_uv[3 * t + 1],
            f[2], corner_uv[3 * t + 2]);
    }
  }
  return text;
}

}  // namespace

std::string TextureFileName(int index, int count) {
  if (count == 1) return "texture.png";
  char name[32];
  std::snprintf(name, sizeof(name), "texture_%03d.png", index);
  return name;
}

std::string ObjText(const core::TriangleMesh& mesh, bool exact) {
  std::string text;
  text.reserve(mesh.vertices.size() * 40 + mesh.triangles.size() * 24);
  for (const Eigen::Vector3d& v : mesh.vertices) {
    Print(&text, exact ? "v %.17g %.17g %.17g\n" : "v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Print(&text, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

void WriteVisual(const core::TexturedMesh& visual, const std::filesystem::path& folder,
                 const std::string& stem, const std::string& shared_texture) {
  const std::vector<std::string> names = MaterialNames(visual);
  const std::vector<std::string> textures = TextureNames(visual, shared_texture);
  core::WriteFile(folder / (stem + ".obj"), VisualObjText(visual, names, stem));
  core::WriteFile(folder / (stem + ".mtl"), MtlText(visual, names, textures));
  for (size_t i = 0; i < textures.size(); ++i) {
    // Pieces of one look share a file, whose name depends on its pixels.
    if (!shared_texture.empty() && std::filesystem::exists(folder / textures[i])) continue;
    core::WritePng(folder / textures[i], visual.textures[i]);
  }
}

}  // namespace simwright::assets
