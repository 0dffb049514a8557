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
  GltfMaterials(const GltfDocument& document, core::TexturedMesh* mesh, PbrLook* look,
                FindingList* findings)
      : document_(document), mesh_(*mesh), look_(*look), findings_(*findings) {}

  // Returns a primitive's material; without one the white default.
  const GltfMaterial& Find(std::optional<size_t> material);

  // Returns true if a material states more than its base colour.
  bool states_look() const { return states_look_; }

 private:
  GltfMaterial Read(const core::Json& source, const std::string& name);
  void ReadTexture(const core::Json& info, GltfMaterial* material, core::Material* target);
  std::optional<size_t> ImageOf(const core::Json& texture);
  bool DecodeImage(size_t image, core::Image* read);
  int ReadImage(size_t image, bool opaque);
  // Reads metallic, roughness and normals into `look_`. `textured`: a texture of the base colour
  // already determines the coordinates.
  void ReadLook(const core::Json& source, bool textured, GltfMaterial* material);
  // Returns the index of a map in `look_`, of one channel of the image or of all (-1); -1 if it
  // cannot be read or uses other coordinates than the material.
  int ReadMap(const core::Json& info, int channel, GltfMaterial* material, bool* placed);
  void SayUnreadMaps(const core::Json& source, const PbrMaterial& look);

  const GltfDocument& document_;
  core::TexturedMesh& mesh_;
  bool states_look_ = false;
  PbrLook& look_;  // parallel to the materials of `mesh_`
  FindingList& findings_;
  std::map<std::pair<size_t, int>, int> maps_;       // (image, channel or -1) -> map or -1
  std::map<long long, GltfMaterial> materials_;      // by index, -1: the default
  std::map<std::pair<size_t, bool>, int> textures_;  // (image, opaque) -> texture or -1
};

// Converts linear light to sRGB, [0, 1].
float ToSrgb(float linear);

}  // namespace simwright::assets
