#include "asset_build/preview.h"

#include <cmath>

#include "render/turntable.h"

namespace simwright::asset_build {
namespace {

// Returns a colour from hues a golden angle apart, so that neighbouring parts differ at any count.
Eigen::Vector4f PartColor(int part) {
  const float hue = std::fmod(0.13f + 0.618034f * static_cast<float>(part), 1.0f) * 6.0f;
  const auto channel = [&](float shift) {
    const float k = std::fmod(shift + hue, 6.0f);
    return 0.92f - 0.5f * std::max(0.0f, std::min({k, 4.0f - k, 1.0f}));
  };
  return {channel(5.0f), channel(3.0f), channel(1.0f), 1.0f};
}

}  // namespace

core::TexturedMesh ColoredParts(const std::vector<core::TriangleMesh>& parts) {
  core::TexturedMesh mesh;
  for (size_t i = 0; i < parts.size(); ++i) {
    core::Append(parts[i], &mesh.mesh);
    const int index = static_cast<int>(i);
    mesh.triangle_material.resize(mesh.mesh.triangles.size(), index);
    mesh.materials.push_back({"part_" + std::to_string(i), PartColor(index), -1});
  }
  return mesh;
}

core::Image RigidView(const assets::Asset& asset, int size) {
  render::TurntableOptions options;
  options.views = 1;
  options.size = size;
  return render::Turntable(asset.visual, options).front();
}

core::Image AssetPreview(const assets::Asset& asset, const core::PbrLook* look) {
  render::TurntableOptions options;
  options.look = look;
  std::vector<core::Image> pictures = render::Turntable(asset.visual, options);
  if (!asset.parts.empty()) {
    const core::TexturedMesh parts = ColoredParts(asset.parts);
    options.samples_per_side = 2;
    options.look = nullptr;
    const std::vector<core::Image> below = render::Turntable(parts, options);
    pictures.insert(pictures.end(), below.begin(), below.end());
  }
  return core::ContactSheet(pictures, options.views);
}

}  // namespace simwright::asset_build
