#include "assets/ply_mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "assets/ply_table.h"
#include "assets/polygon_triangles.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxPlyBytes = 4ull << 30;

// The columns of one element that make a colour, with their full-scale value.
struct ColorColumns {
  const PlyColumn* channels[4] = {};  // the last one is optional
  double full = 1.0;

  CornerColor At(size_t row) const {
    Eigen::Vector4f color = Eigen::Vector4f::Ones();
    for (int k = 0; k < 4; ++k) {
      if (channels[k] == nullptr) continue;
      color[k] = static_cast<float>(channels[k]->values[row] / full);
    }
    return ToCornerColor(color);
  }
};

double FullValue(const PlyColumn& column) {
  if (column.type == "ushort" || column.type == "short") return 65535.0;
  if (column.type != "float" && column.type != "double") return 255.0;
  const auto most = std::max_element(column.values.begin(), column.values.end());
  return most != column.values.end() && *most > 1.0 ? 255.0 : 1.0;
}

std::optional<ColorColumns> FindColors(const PlyElement& element) {
  static constexpr const char* kNames[][4] = {
      {"red", "green", "blue", "alpha"},
      {"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
      {"r", "g", "b", "a"}};
  for (const auto& names : kNames) {
    ColorColumns colors;
    bool complete = true;
    for (int k = 0; k < 4; ++k) {
      const PlyColumn* column = element.Find(names[k]);
      if (column != nullptr && column->is_list) column = nullptr;
      colors.channels[k] = column;
      complete = complete && (column != nullptr || k == 3);
    }
    if (!complete) continue;
    for (int k = 0; k < 3; ++k) colors.full = std::max(colors.full, FullValue(*colors.channels[k]));
    return colors;
  }
  return std::nullopt;
}

class PlyReader {
 public:
  PlyReader(const fs::path& path, FindingList* findings)
      : path_(path), findings_(*findings), vertices_(&raw_.mesh.mesh) {}

  RawMesh Read() {
    table_ = ReadPlyTable(core::ReadFile(path_, kMaxPlyBytes), path_.string());
    FindVertices();
    ReadTextures();
    if (const PlyElement* faces = table_.Find("face")) AddFaces(*faces);
    if (const PlyElement* strips = table_.Find("tristrips")) AddStrips(*strips);
    raw_.mesh.part_names.push_back(path_.stem().string());
    raw_.mesh.triangle_part.assign(raw_.mesh.mesh.triangles.size(), 0);
    if (!has_uvs_) {
      raw_.mesh.corner_uvs.clear();
      for (const int material : raw_.mesh.triangle_material) ++raw_.faces_without_uvs[material];
    }
    return std::move(raw_);
  }

 private:
  struct Corner {
    size_t vertex = 0;
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    CornerColor color{255, 255, 255, 255};
  };

  void FindVertices();
  void ReadTextures();
  void AddFaces(const PlyElement& faces);
  void AddStrips(const PlyElement& strips);
  void AddTriangle(const Corner& a, const Corner& b, const Corner& c, int material);
  Corner MakeCorner(double index) const;

  fs::path path_;
  FindingList& findings_;
  RawMesh raw_;
  VertexIndexer vertices_;
  PlyTable table_;
  std::vector<Eigen::Vector3d> positions_;
  std::optional<ColorColumns> vertex_colors_, face_colors_;
  const PlyColumn* uv_columns_[2] = {};
  bool has_uvs_ = false;
};

void PlyReader::FindVertices() {
  const PlyElement* element = table_.Find("vertex");
  const PlyColumn* axes[3] = {};
  for (int k = 0; k < 3 && element != nullptr; ++k) {
    axes[k] = element->Find(std::string(1, static_cast<char>('x' + k)));
    if (axes[k] == nullptr || axes[k]->is_list) element = nullptr;
  }
  if (element == nullptr) {
    throw core::Error("has no vertices with x, y and z", path_.string(), "export it again");
  }
  if (element->Find("f_dc_0") != nullptr && element->Find("rot_0") != nullptr) {
    throw core::Error("holds Gaussian splats, which have no surface", path_.string(),
                      "make a mesh of them first (SuGaR, 2DGS) and import that");
  }
  for (size_t i = 0; i < element->rows; ++i) {
    positions_.emplace_back(axes[0]->values[i], axes[1]->values[i], axes[2]->values[i]);
  }
  vertex_colors_ = FindColors(*element);
  static constexpr const char* kUvs[][2] = {
      {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
  for (const auto& names : kUvs) {
    const PlyColumn *u = element->Find(names[0]), *v = element->Find(names[1]);
    if (u == nullptr || v == nullptr || u->is_list || v->is_list) continue;
    uv_columns_[0] = u;
    uv_columns_[1] = v;
    has_uvs_ = true;
    break;
  }
}

// Reads "comment TextureFile x.png": material k is the k-th of them.
void PlyReader::ReadTextures() {
  for (const std::string& comment : table_.comments) {
    constexpr std::string_view kKeyword = "TextureFile ";
    if (!comment.starts_with(kKeyword)) continue;
    core::Material material;
    material.name = "texture_" + std::to_string(raw_.mesh.materials.size());
    core::Image image;
    if (ReadTextureFile(path_.parent_path(), comment.substr(kKeyword.size()), &findings_, &image)) {
      material.texture = static_cast<int>(raw_.mesh.textures.size());
      material.base_color.setOnes();
      raw_.mesh.textures.push_back(std::move(image));
    }
    raw_.mesh.materials.push_back(material);
  }
  if (!raw_.mesh.materials.empty()) return;
  core::Material material;
  material.name = "surface";
  raw_.mesh.materials.push_back(material);
}

PlyReader::Corner PlyReader::MakeCorner(double index) const {
  if (!(index >= 0.0) || index >= static_cast<double>(positions_.size())) {
    throw core::Error("a face names vertex " + std::to_string(static_cast<long long>(index)) +
                          " of " + std::to_string(positions_.size()),
                      path_.string(), "it is damaged: export it again");
  }
  Corner corner;
  corner.vertex = static_cast<size_t>(index);
  if (uv_columns_[0] != nullptr) {
    corner.uv = Eigen::Vector2f(static_cast<float>(uv_columns_[0]->values[corner.vertex]),
                                static_cast<float>(uv_columns_[1]->values[corner.vertex]));
  }
  if (vertex_colors_) corner.color = vertex_colors_->At(corner.vertex);
  return corner;
}

void PlyReader::AddTriangle(const Corner& a, const Corner& b, const Corner& c, int material) {
  core::TexturedMesh& mesh = raw_.mesh;
  if (mesh.mesh.triangles.size() >= kMaxMeshFaces) {
    throw core::Error("the mesh has more than 20 million faces", path_.string(),
                      "decimate it first");
  }
  const Eigen::Vector3i t(vertices_.Index(positions_[a.vertex]),
                          vertices_.Index(positions_[b.vertex]),
                          vertices_.Index(positions_[c.vertex]));
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
  mesh.mesh.triangles.push_back(t);
  mesh.triangle_material.push_back(material);
  for (const Corner* corner : {&a, &b, &c}) {
    mesh.corner_uvs.push_back(corner->uv.allFinite() ? corner->uv : Eigen::Vector2f::Zero());
    raw_.AddCornerColor(vertex_colors_ || face_colors_ ? &corner->color : nullptr);
  }
}

void PlyReader::AddFaces(const PlyElement& faces) {
  const PlyColumn* indices = faces.Find("vertex_indices");
  if (indices == nullptr) indices = faces.Find("vertex_index");
  if (indices == nullptr || !indices->is_list) return;
  const PlyColumn* texcoords = faces.Find("texcoord");
  if (texcoords != nullptr && !texcoords->is_list) texcoords = nullptr;
  const PlyColumn* numbers = faces.Find("texnumber");
  if (numbers != nullptr && numbers->is_list) numbers = nullptr;
  if (!vertex_colors_) face_colors_ = FindColors(faces);
  has_uvs_ = has_uvs_ || texcoords != nullptr;
  const int materials = static_cast<int>(raw_.mesh.materials.size());
  for (size_t row = 0; row < faces.rows; ++row) {
    std::vector<Corner> corners;
    std::vector<Eigen::Vector3d> points;
    for (size_t i = indices->starts[row]; i < indices->starts[row + 1]; ++i) {
      corners.push_back(MakeCorner(indices->values[i]));
      points.push_back(positions_[corners.back().vertex]);
    }
    if (corners.size() < 3) continue;
    const size_t uv_start = texcoords ? texcoords->starts[row] : 0;
    const bool wedge = texcoords && texcoords->starts[row + 1] - uv_start == 2 * corners.size();
    for (size_t k = 0; k < corners.size(); ++k) {
      if (face_colors_) corners[k].color = face_colors_->At(row);
      if (!wedge) continue;
      corners[k].uv = Eigen::Vector2f(static_cast<float>(texcoords->values[uv_start + 2 * k]),
                                      static_cast<float>(texcoords->values[uv_start + 2 * k + 1]));
    }
    const double number = numbers != nullptr ? numbers->values[row] : 0.0;
    const int material = number >= 0.0 && number < materials ? static_cast<int>(number) : 0;
    for (const Eigen::Vector3i& t : PolygonTriangles(points)) {
      AddTriangle(corners[static_cast<size_t>(t[0])], corners[static_cast<size_t>(t[1])],
                  corners[static_cast<size_t>(t[2])], material);
    }
  }
}

// Adds strips, which end at -1; every second triangle has the opposite orientation.
void PlyReader::AddStrips(const PlyElement& strips) {
  const PlyColumn* indices = strips.Find("vertex_indices");
  if (indices == nullptr || !indices->is_list) return;
  for (size_t row = 0; row < strips.rows; ++row) {
    size_t start = indices->starts[row];
    for (size_t i = start; i < indices->starts[row + 1]; ++i) {
      if (indices->values[i] < 0.0) {
        start = i + 1;
        continue;
      }
      if (i < start + 2) continue;
      const size_t odd = (i - start) % 2;
      AddTriangle(MakeCorner(indices->values[i - 2 + odd]),
                  MakeCorner(indices->values[i - 1 - odd]), MakeCorner(indices->values[i]), 0);
    }
  }
}

}  // namespace

RawMesh ReadPly(const fs::path& path, FindingList* findings) {
  return PlyReader(path, findings).Read();
}

}  // namespace simwright::assets
