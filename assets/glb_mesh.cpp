#include "assets/glb_mesh.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "assets/corner_normals.h"
#include "core/error.h"

namespace simwright::assets {
namespace {

using core::OrderedJson;

// The attributes of a corner, which corners of one vertex share.
using CornerKey = std::array<float, 12>;

float LinearColour(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

OrderedJson TextureReference(std::size_t texture) {
  OrderedJson reference;
  reference["index"] = texture;
  return reference;
}

// Returns an image of two grey maps as glTF packs them: roughness in green, metallic in blue. A
// missing map is 255, the factor's own value; maps of other sizes are resized to the larger one.
core::Image PackedReflection(const PbrLook& look, const PbrMaterial& pbr) {
  const auto map = [&](int index) -> const core::Image* {
    return index < 0 ? nullptr : &look.images[static_cast<std::size_t>(index)];
  };
  const core::Image* const maps[2] = {map(pbr.roughness_map), map(pbr.metallic_map)};
  int width = 1, height = 1;
  for (const core::Image* image : maps) {
    if (image == nullptr) continue;
    width = std::max(width, image->width);
    height = std::max(height, image->height);
  }
  core::Image packed(width, height, 3, 255);
  for (int channel = 0; channel < 2; ++channel) {
    if (maps[channel] == nullptr) continue;
    const core::Image image = maps[channel]->width == width && maps[channel]->height == height
                                  ? *maps[channel]
                                  : core::Resize(*maps[channel], width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) packed.At(x, y)[1 + channel] = image.At(x, y)[0];
    }
  }
  return packed;
}

bool HasTransparency(const core::Image& image) {
  if (image.channels != 4) return false;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) {
    if (image.pixels[i] != 255) return true;
  }
  return false;
}

OrderedJson MaterialJson(const core::TexturedMesh& visual, const core::Material& material,
                         const PbrMaterial* pbr, const PbrLook& look, GlbBuffer* glb) {
  OrderedJson json;
  if (!material.name.empty()) json["name"] = material.name;
  const Eigen::Vector4f& c = material.base_color;
  OrderedJson& reflection = json["pbrMetallicRoughness"];
  reflection["baseColorFactor"] = {LinearColour(c.x()), LinearColour(c.y()), LinearColour(c.z()),
                                   c.w()};
  bool transparent = c.w() < 1.0f;
  if (material.texture >= 0 && !visual.corner_uvs.empty()) {
    const core::Image& texture = visual.textures.at(static_cast<std::size_t>(material.texture));
    transparent = transparent || HasTransparency(texture);
    reflection["baseColorTexture"] = TextureReference(glb->AddPngTexture(core::EncodePng(texture)));
  }
  // Without a statement a surface is a rough dielectric.
  reflection["metallicFactor"] = pbr == nullptr ? 0.0f : pbr->metallic;
  reflection["roughnessFactor"] = pbr == nullptr ? 1.0f : pbr->roughness;
  if (pbr != nullptr && !visual.corner_uvs.empty()) {
    if (pbr->metallic_map >= 0 || pbr->roughness_map >= 0) {
      reflection["metallicRoughnessTexture"] =
          TextureReference(glb->AddPngTexture(core::EncodePng(PackedReflection(look, *pbr))));
    }
    if (pbr->normal_map >= 0) {
      const core::Image& map = look.images[static_cast<std::size_t>(pbr->normal_map)];
      json["normalTexture"] = TextureReference(glb->AddPngTexture(core::EncodePng(map)));
      json["normalTexture"]["scale"] = pbr->normal_scale;
    }
  }
  if (transparent) json["alphaMode"] = "BLEND";
  json["doubleSided"] = true;
  return json;
}

// The vertices of a primitive, each with the attributes of its corners.
struct PrimitiveVertices {
  std::vector<float> positions, normals, uvs, tangents;
  std::vector<std::uint32_t> indices;
  std::map<CornerKey, std::uint32_t> known;
  bool with_uvs = false, with_tangents = false;

  void Add(const CornerKey& corner) {
    const auto [at, fresh] = known.try_emplace(corner, static_cast<std::uint32_t>(known.size()));
    indices.push_back(at->second);
    if (!fresh) return;
    positions.insert(positions.end(), corner.begin(), corner.begin() + 3);
    normals.insert(normals.end(), corner.begin() + 3, corner.begin() + 6);
    if (with_uvs) uvs.insert(uvs.end(), corner.begin() + 6, corner.begin() + 8);
    if (with_tangents) tangents.insert(tangents.end(), corner.begin() + 8, corner.end());
  }

  OrderedJson Json(std::size_t material, bool has_material, GlbBuffer* glb) const {
    OrderedJson json;
    json["attributes"]["POSITION"] = glb->AddFloats(positions, 3, true);
    json["attributes"]["NORMAL"] = glb->AddFloats(normals, 3, false);
    if (with_uvs) json["attributes"]["TEXCOORD_0"] = glb->AddFloats(uvs, 2, false);
    if (with_tangents) json["attributes"]["TANGENT"] = glb->AddFloats(tangents, 4, false);
    json["indices"] = glb->AddIndices(indices);
    if (has_material) json["material"] = material;
    return json;
  }
};

}  // namespace

std::vector<Eigen::Vector4f> CornerTangents(const core::TexturedMesh& visual,
                                            const std::vector<Eigen::Vector3d>& normals) {
  // Position, normal and coordinates of a corner, and whether its face is mirrored.
  using TangentKey = std::array<double, 9>;
  const core::TriangleMesh& mesh = visual.mesh;
  std::vector<TangentKey> keys(normals.size());
  std::map<TangentKey, Eigen::Vector3d> sums;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Eigen::Vector3d corners[3];
    Eigen::Vector2d uvs[3];
    for (int k = 0; k < 3; ++k) {
      corners[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
      uvs[k] = visual.corner_uvs[3 * t + static_cast<std::size_t>(k)].cast<double>();
    }
    const Eigen::Vector2d a = uvs[1] - uvs[0], b = uvs[2] - uvs[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    const double side = area < 0.0 ? -1.0 : 1.0;
    const Eigen::Vector3d along_u =
        side * ((corners[1] - corners[0]) * b.y() - (corners[2] - corners[0]) * a.y());
    for (int k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * t + static_cast<std::size_t>(k);
      const Eigen::Vector3d& n = normals[corner];
      keys[corner] = {corners[k].x(), corners[k].y(), corners[k].z(), n.x(), n.y(),
                      n.z(),          uvs[k].x(),     uvs[k].y(),     side};
      const Eigen::Vector3d flat = along_u - along_u.dot(n) * n;
      const Eigen::Vector3d left = corners[(k + 1) % 3] - corners[k];
      const Eigen::Vector3d right = corners[(k + 2) % 3] - corners[k];
      const double angle = std::atan2(left.cross(right).norm(), left.dot(right));
      const auto at = sums.try_emplace(keys[corner], Eigen::Vector3d::Zero()).first;
      at->second += angle * flat.stableNormalized();
    }
  }
  std::vector<Eigen::Vector4f> tangents(normals.size());
  for (std::size_t corner = 0; corner < normals.size(); ++corner) {
    Eigen::Vector3d tangent = sums.at(keys[corner]);
    if (tangent.norm() < 1e-9) tangent = normals[corner].unitOrthogonal();
    tangents[corner] << tangent.normalized().cast<float>(), static_cast<float>(keys[corner][8]);
  }
  return tangents;
}

std::size_t AddGlbMesh(const std::string& name, const core::TexturedMesh& visual,
                       const PbrLook& look, GlbBuffer* glb) {
  const core::TriangleMesh& mesh = visual.mesh;
  const std::vector<Eigen::Vector3d> normals = CornerNormals(mesh);
  const bool with_uvs = !visual.corner_uvs.empty();
  std::vector<Eigen::Vector4f> tangents;
  std::vector<PrimitiveVertices> primitives(std::max<std::size_t>(1, visual.materials.size()));
  for (std::size_t m = 0; m < primitives.size(); ++m) {
    primitives[m].with_uvs = with_uvs;
    primitives[m].with_tangents =
        with_uvs && m < look.materials.size() && look.materials[m].normal_map >= 0;
    if (primitives[m].with_tangents && tangents.empty()) tangents = CornerTangents(visual, normals);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t material = visual.triangle_material.empty()
                                     ? 0
                                     : static_cast<std::size_t>(visual.triangle_material[t]);
    PrimitiveVertices& primitive = primitives.at(material);
    for (int k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * t + static_cast<std::size_t>(k);
      const Eigen::Vector3f p =
          mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])].cast<float>();
      const Eigen::Vector3f n = normals[corner].cast<float>().normalized();
      CornerKey key = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
      if (with_uvs) {
        // glTF's origin is the upper left.
        key[6] = visual.corner_uvs[corner].x();
        key[7] = 1.0f - visual.corner_uvs[corner].y();
      }
      if (primitive.with_tangents) {
        for (int c = 0; c < 4; ++c) key[static_cast<std::size_t>(8 + c)] = tangents[corner][c];
      }
      primitive.Add(key);
    }
  }
  OrderedJson json = {{"name", name}};
  for (std::size_t m = 0; m < primitives.size(); ++m) {
    if (primitives[m].indices.empty()) continue;
    const bool has_material = m < visual.materials.size();
    if (has_material) {
      const PbrMaterial* pbr = m < look.materials.size() ? &look.materials[m] : nullptr;
      // Its textures grow the document, so that it is added last.
      const OrderedJson material = MaterialJson(visual, visual.materials[m], pbr, look, glb);
      glb->root["materials"].push_back(material);
    }
    const std::size_t material = has_material ? glb->root["materials"].size() - 1 : 0;
    json["primitives"].push_back(primitives[m].Json(material, has_material, glb));
  }
  glb->root["meshes"].push_back(json);
  return glb->root["meshes"].size() - 1;
}

}  // namespace simwright::assets
