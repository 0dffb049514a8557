#include "tests/importers/damaged/specimen_file.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "core/files.h"
#include "core/image.h"
#include "tests/assets/gltf_builder.h"

namespace simwright::damaged {
namespace fs = std::filesystem;
namespace {

using Eigen::Vector3d;

// Bands of colour along the object.
Eigen::Vector3f ColorAt(const Vector3d& at) {
  const float wave = std::isfinite(at.sum()) ? static_cast<float>(std::sin(40.0 * at.sum())) : 0.0f;
  return {0.5f + 0.4f * wave, 0.4f, 0.6f - 0.3f * wave};
}

template <typename... Values>
void AddLine(std::string* text, const char* format, Values... values) {
  char line[200];
  text->append(line, static_cast<std::size_t>(std::snprintf(line, sizeof line, format, values...)));
}

std::string ObjOf(const core::TriangleMesh& mesh) {
  std::string text = "o generated\n";
  for (const Vector3d& v : mesh.vertices) AddLine(&text, "v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    AddLine(&text, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

std::string PlyOf(const Specimen& specimen) {
  const core::TriangleMesh& mesh = specimen.mesh;
  std::string text = "ply\nformat ascii 1.0\n";
  AddLine(&text, "element vertex %zu\nproperty double x\nproperty double y\nproperty double z\n",
          mesh.vertices.size());
  if (specimen.vertex_colors) {
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  AddLine(&text, "element face %zu\nproperty list uchar int vertex_indices\nend_header\n",
          mesh.triangles.size());
  for (const Vector3d& v : mesh.vertices) {
    AddLine(&text, "%.12g %.12g %.12g", v.x(), v.y(), v.z());
    const Eigen::Vector3i color = (255.0f * ColorAt(v)).cast<int>();
    if (specimen.vertex_colors) AddLine(&text, " %d %d %d", color[0], color[1], color[2]);
    text += "\n";
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    AddLine(&text, "3 %d %d %d\n", t[0], t[1], t[2]);
  }
  return text;
}

std::string StlOf(const core::TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto add = [&](const void* from, std::size_t count) {
    bytes.append(static_cast<const char*>(from), count);
  };
  const std::uint32_t count = static_cast<std::uint32_t>(mesh.triangles.size());
  add(&count, 4);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    float numbers[12] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) {
        numbers[3 + 3 * k + c] = static_cast<float>(mesh.vertices[t[k]][c]);
      }
    }
    add(numbers, sizeof numbers);
    add("\0", 2);
  }
  return bytes;
}

// A pattern by which a channel of a texture is recognised.
std::string TexturePng(const Eigen::Vector3i& first, const Eigen::Vector3i& second) {
  core::Image image(64, 64, 3);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3i& color = (x / 8 + y / 8) % 2 == 0 ? first : second;
      for (int k = 0; k < 3; ++k) image.At(x, y)[k] = static_cast<std::uint8_t>(color[k]);
    }
  }
  return core::EncodePng(image);
}

void AddPbrMaterial(assets::GltfBuilder* gltf) {
  gltf->root["materials"][0]["name"] = "generated";
  gltf->AddTexture(TexturePng({200, 60, 40}, {230, 200, 160}));
  const auto add = [&](const std::string& png) {
    gltf->root["images"].push_back(
        {{"bufferView", gltf->AddBytes(png)}, {"mimeType", "image/png"}});
    gltf->root["textures"].push_back({{"source", gltf->root["images"].size() - 1}});
    return gltf->root["textures"].size() - 1;
  };
  nlohmann::json& material = gltf->root["materials"][0];
  material["pbrMetallicRoughness"]["metallicFactor"] = 0.5;
  material["pbrMetallicRoughness"]["roughnessFactor"] = 0.8;
  material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] =
      add(TexturePng({0, 100, 20}, {0, 220, 240}));
  material["normalTexture"]["index"] = add(TexturePng({128, 128, 255}, {150, 128, 250}));
}

std::string GlbOf(const Specimen& specimen) {
  assets::GltfBuilder gltf;
  std::vector<float> positions, colors, coordinates;
  std::vector<std::uint32_t> indices;
  const double mirror = specimen.mirrored_node ? -1.0 : 1.0;
  const auto add_vertex = [&](const Vector3d& v) {
    for (const double c : {mirror * v.x(), v.z(), -v.y()}) {
      positions.push_back(static_cast<float>(c));
    }
    for (const float c : ColorAt(v)) colors.push_back(c);
  };
  if (specimen.pbr_textures) {
    const double scale = 1.0 / specimen.sides.maxCoeff();
    for (std::size_t t = 0; t < specimen.mesh.triangles.size(); ++t) {
      const Vector3d normal = core::TriangleAreaVector(specimen.mesh, static_cast<int>(t));
      int axis = 0;
      normal.cwiseAbs().maxCoeff(&axis);
      for (int k = 0; k < 3; ++k) {
        const Vector3d& v = specimen.mesh.vertices[specimen.mesh.triangles[t][k]];
        add_vertex(v);
        coordinates.push_back(static_cast<float>(scale * v[(axis + 1) % 3]));
        coordinates.push_back(static_cast<float>(scale * v[(axis + 2) % 3]));
        indices.push_back(static_cast<std::uint32_t>(indices.size()));
      }
    }
  } else {
    for (const Vector3d& v : specimen.mesh.vertices) add_vertex(v);
    for (const Eigen::Vector3i& t : specimen.mesh.triangles) {
      for (int k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint32_t>(t[k]));
    }
  }
  // A mirrored node turns faces round, so the file's faces are wound the other way.
  if (specimen.mirrored_node) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
    gltf.root["nodes"][0]["scale"] = {-1, 1, 1};
  }
  nlohmann::json primitive = {{"mode", 4}};
  primitive["attributes"]["POSITION"] = gltf.AddFloats(positions, "VEC3", 3);
  primitive["indices"] = gltf.Add(indices, 5125, "SCALAR", 1);
  if (specimen.vertex_colors) {
    primitive["attributes"]["COLOR_0"] = gltf.AddFloats(colors, "VEC3", 3);
  }
  if (specimen.pbr_textures) {
    primitive["attributes"]["TEXCOORD_0"] = gltf.AddFloats(coordinates, "VEC2", 2);
    AddPbrMaterial(&gltf);
    primitive["material"] = 0;
  }
  gltf.root["meshes"] = {{{"name", "generated"}, {"primitives", {primitive}}}};
  return gltf.Glb();
}

}  // namespace

fs::path WriteSpecimen(const Specimen& specimen, const std::string& name, const fs::path& folder) {
  const fs::path path = folder / (name + "." + specimen.format);
  if (specimen.format == "obj") {
    core::WriteFile(path, ObjOf(specimen.mesh));
  } else if (specimen.format == "ply") {
    core::WriteFile(path, PlyOf(specimen));
  } else if (specimen.format == "stl") {
    core::WriteFile(path, StlOf(specimen.mesh));
  } else {
    core::WriteFile(path, GlbOf(specimen));
  }
  return path;
}

}  // namespace simwright::damaged
