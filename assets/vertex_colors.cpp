#include "assets/vertex_colors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace simwright::assets {
namespace {

constexpr CornerColor kWhite{255, 255, 255, 255};
constexpr size_t kMostMaterials = 32;  // maximum number of colours that become materials

using TriangleColors = std::array<CornerColor, 3>;

struct TriangleColorsHash {
  size_t operator()(const TriangleColors& colors) const {
    std::uint64_t h = 1469598103934665603ull;
    for (const CornerColor& color : colors) {
      for (const std::uint8_t value : color) h = (h ^ value) * 1099511628211ull;
    }
    return static_cast<size_t>(h);
  }
};

CornerColor MeanOf(const TriangleColors& colors) {
  CornerColor mean;
  for (size_t k = 0; k < 4; ++k) {
    mean[k] = static_cast<std::uint8_t>((colors[0][k] + colors[1][k] + colors[2][k] + 1) / 3);
  }
  return mean;
}

class Painter {
 public:
  Painter(RawMesh* raw, FindingList* findings)
      : mesh_(raw->mesh),
        colors_(raw->corner_colors),
        multiply_(raw->colors_multiply),
        findings_(*findings) {}

  void Paint() {
    if (std::all_of(colors_.begin(), colors_.end(), [](const auto& c) { return c == kWhite; })) {
      return;
    }
    if (mesh_.triangle_material.empty()) {
      mesh_.triangle_material.assign(mesh_.mesh.triangles.size(), 0);
      if (mesh_.materials.empty()) mesh_.materials.push_back({"surface"});
    }
    FindPaintable();
    if (paintable_.empty()) return;
    if (!PaintMaterials()) PaintTexture();
  }

 private:
  TriangleColors ColorsOf(int t) const {
    const size_t at = 3 * static_cast<size_t>(t);
    return {colors_[at], colors_[at + 1], colors_[at + 2]};
  }

  void FindPaintable();
  bool PaintMaterials();
  void PaintTexture();
  void MultiplyAll(int material, const CornerColor& color);
  core::Material Painted(int material, const CornerColor& color) const;

  core::TexturedMesh& mesh_;
  const std::vector<CornerColor>& colors_;
  bool multiply_;
  FindingList& findings_;
  std::vector<int> paintable_;  // triangles whose colours are kept
};

core::Material Painter::Painted(int material, const CornerColor& color) const {
  core::Material painted = mesh_.materials[static_cast<size_t>(material)];
  for (int k = 0; k < 4; ++k) {
    const float value = static_cast<float>(color[static_cast<size_t>(k)]) / 255.0f;
    painted.base_color[k] = multiply_ || k == 3 ? painted.base_color[k] * value : value;
  }
  return painted;
}

void Painter::MultiplyAll(int material, const CornerColor& color) {
  core::Material& target = mesh_.materials[static_cast<size_t>(material)];
  for (int k = 0; k < 4; ++k) {
    target.base_color[k] *= static_cast<float>(color[static_cast<size_t>(k)]) / 255.0f;
  }
}

// Finds the triangles to paint. Materials with a texture keep it; a uniform colour is multiplied
// into them.
void Painter::FindPaintable() {
  struct Seen {
    CornerColor color = kWhite;
    bool any = false, varies = false;
  };
  std::vector<Seen> seen(mesh_.materials.size());
  const int count = static_cast<int>(mesh_.mesh.triangles.size());
  for (int t = 0; t < count; ++t) {
    Seen& s = seen[static_cast<size_t>(mesh_.triangle_material[static_cast<size_t>(t)])];
    for (const CornerColor& color : ColorsOf(t)) {
      if (!s.any) s.color = color;
      s.varies = s.varies || color != s.color;
      s.any = true;
    }
  }
  for (size_t m = 0; m < seen.size(); ++m) {
    if (mesh_.materials[m].texture < 0 || !seen[m].any) continue;
    if (seen[m].varies) {
      findings_.Add(core::Severity::kWarning, "vertex-colors-left-out",
                    "material '" + mesh_.materials[m].name +
                        "' has a texture and vertex colours: the texture is kept",
                    "bake both into one texture (Blender: Bake, Diffuse, Color)");
    } else if (multiply_) {
      MultiplyAll(static_cast<int>(m), seen[m].color);
    }
  }
  for (int t = 0; t < count; ++t) {
    const int material = mesh_.triangle_material[static_cast<size_t>(t)];
    if (mesh_.materials[static_cast<size_t>(material)].texture < 0) paintable_.push_back(t);
  }
}

bool Painter::PaintMaterials() {
  std::map<std::pair<int, CornerColor>, int> material_of;
  for (const int t : paintable_) {
    const TriangleColors colors = ColorsOf(t);
    if (colors[0] != colors[1] || colors[1] != colors[2]) return false;
    material_of.try_emplace({mesh_.triangle_material[static_cast<size_t>(t)], colors[0]}, -1);
    if (material_of.size() > kMostMaterials) return false;
  }
  std::map<int, int> colors_of;  // the number of colours of a source material
  for (const auto& [key, unused] : material_of) ++colors_of[key.first];
  for (auto& [key, index] : material_of) {
    core::Material painted = Painted(key.first, key.second);
    if (colors_of[key.first] == 1) {  // keeps the original material
      mesh_.materials[static_cast<size_t>(key.first)] = painted;
      index = key.first;
      continue;
    }
    index = static_cast<int>(mesh_.materials.size());
    painted.name += "_" + std::to_string(index);
    mesh_.materials.push_back(painted);
  }
  for (const int t : paintable_) {
    int& material = mesh_.triangle_material[static_cast<size_t>(t)];
    material = material_of.at({material, ColorsOf(t)[0]});
  }
  return true;
}

// Blocks of texels in one image, row by row.
class Atlas {
 public:
  Atlas(size_t blocks, int side) : side_(side) {
    columns_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(blocks)))));
    const int rows = static_cast<int>((blocks + static_cast<size_t>(columns_) - 1) /
                                      static_cast<size_t>(columns_));
    image_ = core::Image(columns_ * side, std::max(1, rows) * side, 3, 255);
  }
  void Set(int block, int x, int y, const CornerColor& color) {
    std::uint8_t* texel = image_.At(block % columns_ * side_ + x, block / columns_ * side_ + y);
    std::copy_n(color.begin(), 3, texel);
  }
  // Returns the centre of a block's texel, origin at the image's lower left.
  Eigen::Vector2f Uv(int block, int x, int y) const {
    const int column = block % columns_, row = block / columns_;
    const double u = (column * side_ + x + 0.5) / image_.width;
    const double v = 1.0 - (row * side_ + y + 0.5) / image_.height;
    return {static_cast<float>(u), static_cast<float>(v)};
  }
  core::Image Take() { return std::move(image_); }

 private:
  int side_;
  int columns_ = 1;
  core::Image image_;
};

// Fills a block: corners lie on texels (0, 0), (1, 0) and (0, 1); the fourth texel extends the
// plane through them.
void FillBlock(int block, const TriangleColors& colors, Atlas* atlas) {
  CornerColor fourth;
  for (size_t k = 0; k < 4; ++k) {
    fourth[k] =
        static_cast<std::uint8_t>(std::clamp(colors[1][k] + colors[2][k] - colors[0][k], 0, 255));
  }
  atlas->Set(block, 0, 0, colors[0]);
  atlas->Set(block, 1, 0, colors[1]);
  atlas->Set(block, 0, 1, colors[2]);
  atlas->Set(block, 1, 1, fourth);
}

void Painter::PaintTexture() {
  constexpr size_t kMostBlocks = static_cast<size_t>(kMaxTextureSide / 2) * (kMaxTextureSide / 2);
  const auto painted_colors = [&](int t) {
    TriangleColors colors = ColorsOf(t);
    if (!multiply_) return colors;
    const int material = mesh_.triangle_material[static_cast<size_t>(t)];
    for (CornerColor& color : colors) color = ToCornerColor(Painted(material, color).base_color);
    return colors;
  };
  std::unordered_map<TriangleColors, int, TriangleColorsHash> block_of;
  bool flat = false;
  for (const int t : paintable_) {
    block_of.try_emplace(painted_colors(t), static_cast<int>(block_of.size()));
    flat = block_of.size() > kMostBlocks;
    if (flat) break;
  }
  const auto key_of = [&](int t) {
    TriangleColors colors = painted_colors(t);
    if (!flat) return colors;
    CornerColor mean = MeanOf(colors);
    for (std::uint8_t& value : mean) {
      value = static_cast<std::uint8_t>((value & 0xf8) | value >> 5);
    }
    return TriangleColors{mean, mean, mean};
  };
  if (flat) {
    block_of.clear();
    for (const int t : paintable_) {
      block_of.try_emplace(key_of(t), static_cast<int>(block_of.size()));
    }
    findings_.Add(core::Severity::kInfo, "vertex-colors-rounded",
                  "vertex colours are reduced to one rounded colour per triangle",
                  "decimate the mesh and bake its colours into a texture for more detail");
  }
  Atlas atlas(block_of.size(), 2);
  for (const auto& [colors, block] : block_of) FillBlock(block, colors, &atlas);
  if (mesh_.corner_uvs.empty()) {
    mesh_.corner_uvs.assign(3 * mesh_.mesh.triangles.size(), Eigen::Vector2f::Zero());
  }
  const int texture = static_cast<int>(mesh_.textures.size());
  std::map<std::pair<int, int>, int> material_of;  // (source material, alpha in 16ths) -> painted
  for (const int t : paintable_) {
    const int block = block_of.at(key_of(t));
    const size_t at = 3 * static_cast<size_t>(t);
    mesh_.corner_uvs[at] = atlas.Uv(block, 0, 0);
    mesh_.corner_uvs[at + 1] = atlas.Uv(block, 1, 0);
    mesh_.corner_uvs[at + 2] = atlas.Uv(block, 0, 1);
    int& material = mesh_.triangle_material[static_cast<size_t>(t)];
    const int alpha = (MeanOf(ColorsOf(t))[3] + 1) / 16;
    const auto [entry, fresh] =
        material_of.try_emplace({material, alpha}, static_cast<int>(mesh_.materials.size()));
    if (fresh) {
      core::Material painted = mesh_.materials[static_cast<size_t>(material)];
      painted.name += "_" + std::to_string(entry->second);
      painted.base_color.head<3>().setOnes();
      painted.base_color.w() *= static_cast<float>(alpha) / 16.0f;
      painted.texture = texture;
      mesh_.materials.push_back(painted);
    }
    material = entry->second;
  }
  mesh_.textures.push_back(atlas.Take());
}

}  // namespace

void ApplyVertexColors(RawMesh* raw, FindingList* findings) {
  if (!raw->corner_colors.empty()) Painter(raw, findings).Paint();
  raw->corner_colors.clear();
}

}  // namespace simwright::assets
