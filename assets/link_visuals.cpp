#include "assets/link_visuals.h"

#include <utility>

#include "assets/mesh_import.h"

namespace simwright::assets {

std::vector<LinkVisual> LinkVisuals(const UrdfModel& model) {
  std::vector<LinkVisual> visuals;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const UrdfLink& link = model.links[i];
    for (const UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      LinkVisual visual;
      visual.link = static_cast<int>(i);
      if (shape.file.empty()) visual.mesh = shape.mesh;
      visual.file = shape.file;
      visual.link_from_file = shape.link_from_file;
      visual.color = shape.color;
      visuals.push_back(std::move(visual));
    }
  }
  return visuals;
}

core::TexturedMesh ReadVisual(const LinkVisual& visual, const Eigen::Vector4f& plain) {
  if (visual.file.empty()) return InOneColor(visual.mesh, visual.color.value_or(plain));
  core::TexturedMesh seen = ReadMesh(visual.file);
  core::Transform(visual.link_from_file, &seen.mesh);
  if (seen.textures.empty() && visual.color) {
    for (core::Material& material : seen.materials) material.base_color = *visual.color;
  }
  return seen;
}

core::TexturedMesh InOneColor(core::TriangleMesh mesh, const Eigen::Vector4f& color) {
  core::TexturedMesh colored;
  colored.mesh = std::move(mesh);
  colored.triangle_material.assign(colored.mesh.triangles.size(), 0);
  colored.materials.push_back({"plain", color, -1});
  return colored;
}

}  // namespace simwright::assets
