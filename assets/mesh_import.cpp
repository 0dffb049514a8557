#include "assets/mesh_import.h"

#include <algorithm>
#include <vector>

#include "assets/assimp_mesh.h"
#include "assets/broken_faces.h"
#include "assets/gltf_mesh.h"
#include "assets/mesh_format.h"
#include "assets/missing_uvs.h"
#include "assets/ply_mesh.h"
#include "assets/read_mesh.h"
#include "assets/vertex_colors.h"
#include "core/error.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

// Makes fully transparent materials opaque: exporters that confuse opacity and transparency produce
// invisible objects.
void ShowInvisibleMaterials(core::TexturedMesh* mesh, FindingList* findings) {
  std::vector<bool> used(mesh->materials.size(), false);
  for (const int material : mesh->triangle_material) used[static_cast<size_t>(material)] = true;
  for (size_t m = 0; m < mesh->materials.size(); ++m) {
    core::Material& material = mesh->materials[m];
    if (!used[m] || material.base_color.w() > 0.0f) continue;
    material.base_color.w() = 1.0f;
    findings->Add(core::Severity::kWarning, "material-invisible",
                  "material '" + material.name + "' is fully transparent: it is made opaque",
                  "correct its opacity in the file (MTL: d 1), or delete what should be invisible");
  }
}

// Omits the maps of materials whose texture coordinates the painting of vertex colours replaced.
void DropReplacedMaps(const std::vector<core::Material>& stated, RawMesh* raw,
                      FindingList* findings) {
  for (size_t m = 0; m < std::min(stated.size(), raw->look.materials.size()); ++m) {
    PbrMaterial& pbr = raw->look.materials[m];
    if (stated[m].texture == raw->mesh.materials[m].texture || !pbr.HasMaps()) continue;
    pbr.metallic_map = pbr.roughness_map = pbr.normal_map = -1;
    findings->Add(core::Severity::kInfo, "gltf-maps-not-read",
                  "material '" + stated[m].name +
                      "' has vertex colours: its maps of metal, roughness and normals are ignored",
                  "bake the colours into a texture");
  }
}

RawMesh ReadRaw(const fs::path& path, FindingList* findings) {
  switch (MeshFormatOf(path)) {
    case MeshFormat::kGlb:
    case MeshFormat::kGltf:
      return ReadGltf(path, findings);
    case MeshFormat::kPly:
      return ReadPly(path, findings);
    default:
      return ReadWithAssimp(path, findings);
  }
}

}  // namespace

bool HasMeshExtension(const fs::path& path) {
  return MeshFormatOf(path) != MeshFormat::kUnknown;
}

Eigen::Matrix3d ZUpRotation(char up) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (up == 'y') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == 'x') turn << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return turn;
}

MeshFile ReadMeshFile(const fs::path& path) {
  RequireMeshFile(path);
  FindingList findings(path.filename().string());
  // The path must not contain "." and "..", so that its parent is the folder above.
  RawMesh raw = ReadRaw(fs::absolute(path).lexically_normal(), &findings);
  if (raw.mesh.mesh.triangles.empty()) {
    throw core::Error("the mesh has no faces", path.string(),
                      "export its surface: points and lines have none (convert a point cloud to a "
                      "mesh first, in MeshLab or CloudCompare)");
  }
  DropTexturesWithoutUvs(&raw, &findings);
  DropBrokenFaces(&raw, &findings);
  const std::vector<core::Material> stated = raw.mesh.materials;
  ApplyVertexColors(&raw, &findings);
  DropReplacedMaps(stated, &raw, &findings);
  ShowInvisibleMaterials(&raw.mesh, &findings);
  core::RequireValid(raw.mesh, path.string());
  return {std::move(raw.mesh), raw.up, findings.Take(), std::move(raw.look)};
}

core::TexturedMesh ReadMesh(const fs::path& path) {
  return ReadMeshFile(path).mesh;
}

}  // namespace simwright::assets
