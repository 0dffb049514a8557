#include "importers/rigid_urdf.h"

#include <Eigen/LU>

#include "assets/joint_poses.h"
#include "assets/mesh_import.h"
#include "core/error.h"

namespace simwright::importers {
namespace {

// Appends `addition` with all of its attributes; fills per-triangle arrays that only one of the two
// has.
void AppendTextured(core::TexturedMesh addition, core::TexturedMesh* whole) {
  const auto fill = [](core::TexturedMesh* mesh) {
    const size_t triangles = mesh->mesh.triangles.size();
    if (mesh->materials.empty()) mesh->materials.push_back({});
    mesh->triangle_material.resize(triangles, 0);
    mesh->corner_uvs.resize(3 * triangles, Eigen::Vector2f::Zero());
  };
  fill(&addition);
  const int first_material = static_cast<int>(whole->materials.size());
  const int first_texture = static_cast<int>(whole->textures.size());
  core::Append(addition.mesh, &whole->mesh);
  for (core::Material material : addition.materials) {
    if (material.texture >= 0) material.texture += first_texture;
    material.name = "material_" + std::to_string(whole->materials.size());
    whole->materials.push_back(material);
  }
  for (const int material : addition.triangle_material) {
    whole->triangle_material.push_back(first_material + material);
  }
  whole->corner_uvs.insert(whole->corner_uvs.end(), addition.corner_uvs.begin(),
                           addition.corner_uvs.end());
  whole->textures.insert(whole->textures.end(), addition.textures.begin(), addition.textures.end());
}

core::TexturedMesh TexturedShape(const assets::UrdfShape& shape, core::Findings* findings) {
  core::TexturedMesh mesh;
  if (shape.file.empty()) {
    mesh.mesh = shape.mesh;
  } else {
    assets::MeshFile file = assets::ReadMeshFile(shape.file);
    findings->insert(findings->end(), file.findings.begin(), file.findings.end());
    mesh = std::move(file.mesh);
    core::Transform(shape.link_from_file, &mesh.mesh);
    if (shape.link_from_file.linear().determinant() < 0.0 && !mesh.corner_uvs.empty()) {
      // Transform reversed the triangles' winding by swapping their last two corners.
      for (size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
        std::swap(mesh.corner_uvs[3 * t + 1], mesh.corner_uvs[3 * t + 2]);
      }
    }
  }
  mesh.triangle_part.clear();
  mesh.part_names.clear();
  if (shape.color) {
    mesh.triangle_material.clear();
    mesh.materials = {{"color", *shape.color, -1}};
    mesh.textures.clear();
    mesh.corner_uvs.clear();
  }
  return mesh;
}

}  // namespace

core::TexturedMesh RigidVisual(const assets::UrdfModel& model, core::Findings* findings) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  core::TexturedMesh whole;
  for (size_t i = 0; i < model.links.size(); ++i) {
    const assets::UrdfLink& link = model.links[i];
    for (const assets::UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      core::TexturedMesh mesh = TexturedShape(shape, findings);
      core::Transform(Eigen::Affine3d(poses[i]), &mesh.mesh);
      AppendTextured(std::move(mesh), &whole);
    }
  }
  if (whole.mesh.empty()) {
    throw core::Error("no link has a readable shape", model.name,
                      "give it a mesh, or correct the file names of its meshes");
  }
  if (whole.textures.empty()) whole.corner_uvs.clear();
  return whole;
}

double StatedMass(const assets::UrdfModel& model) {
  double mass = 0.0;
  for (const assets::UrdfLink& link : model.links) {
    const bool shapes = !link.visuals.empty() || !link.collisions.empty();
    if (shapes && !link.inertial) return 0.0;
    if (link.inertial) mass += link.inertial->mass;
  }
  return mass;
}

}  // namespace simwright::importers
