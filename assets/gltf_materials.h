#pragma once

#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "assets/gltf_document.h"
#include "assets/read_mesh.h"

namespace simwright::assets {

// The supported part of a glTF material, and its texture coordinate transform.
struct GltfMaterial {
  int index = 0;                                          // into the mesh's materials
  size_t texcoord = 0;                                    // TEXCOORD_n of its base colour
  Eigen::Matrix2f uv_turn = Eigen::Matrix2f::Identity();  // KHR_texture_transform
  Eigen::Vector2f uv_offset = Eigen::Vector2f::Zero();
  bool wraps = true;   // false: its sampler clamps or mirrors
  bool opaque = true;  // alphaMode OPAQUE: alpha is ignored

  // Converts glTF coordinates (origin at the image's upper left) to ours (lower left).
  Eigen::Vector2f Uv(const Eigen::Vector2f& read) const;
};

// Creates a document's materials and textures on demand.
class GltfMaterials {
 public:
  GltfMaterials(const GltfDocument& document, core::TexturedMesh* mesh, FindingList* findings)
      : document_(document), mesh_(*mesh), findings_(*findings) {}

  // Returns a primitive's material; without one the white default.
  const GltfMaterial& Find(std::optional<size_t> material);

 private:
  GltfMaterial Read(const core::Json& source, const std::string& name);
  void ReadTexture(const core::Json& info, GltfMaterial* material, core::Material* target);
  int ReadImage(size_t image, bool opaque);
  void SayUnreadMaps(const core::Json& source);

  const GltfDocument& document_;
  core::TexturedMesh& mesh_;
  FindingList& findings_;
  std::map<long long, GltfMaterial> materials_;      // by index, -1: the default
  std::map<std::pair<size_t, bool>, int> textures_;  // (image, opaque) -> texture or -1
};

// Converts linear light to sRGB, [0, 1].
float ToSrgb(float linear);

}  // namespace simwright::assets
