#include "assets/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::assets {
using core::Json;
namespace {

Eigen::Vector4f Factor(const Json& object, const char* name) {
  const std::vector<double> read = NumbersMember(object, name, {1, 1, 1, 1});
  Eigen::Vector4f color;
  for (int k = 0; k < 4; ++k) {
    color[k] = std::clamp(static_cast<float>(read[static_cast<size_t>(k)]), 0.0f, 1.0f);
  }
  for (int k = 0; k < 3; ++k) color[k] = ToSrgb(color[k]);
  return color;
}

// Reads which texture coordinates a texture uses, and their transform.
void PlaceCoordinates(const Json& info, GltfMaterial* material) {
  material->texcoord = IndexMember(info, "texCoord").value_or(0);
  if (const Json* transform = Extension(info, "KHR_texture_transform")) {
    material->texcoord = IndexMember(*transform, "texCoord").value_or(material->texcoord);
    const std::vector<double> offset = NumbersMember(*transform, "offset", {0, 0});
    const std::vector<double> scale = NumbersMember(*transform, "scale", {1, 1});
    const double angle = core::NumberMember(*transform, "rotation", 0.0);
    // The rotation is counter-clockwise in the image, whose v points down.
    Eigen::Matrix2d turn;
    turn << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
    material->uv_turn = (turn * Eigen::Vector2d(scale[0], scale[1]).asDiagonal()).cast<float>();
    material->uv_offset = Eigen::Vector2d(offset[0], offset[1]).cast<float>();
  }
}

const Json kEmpty = Json::object();

const Json& ObjectMember(const Json& object, const char* name) {
  const Json* member = core::FindMember(object, name);
  return member != nullptr && member->is_object() ? *member : kEmpty;
}

}  // namespace

float ToSrgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

Eigen::Vector2f GltfMaterial::Uv(const Eigen::Vector2f& read) const {
  const Eigen::Vector2f uv = uv_turn * read + uv_offset;
  return {uv.x(), 1.0f - uv.y()};
}

const GltfMaterial& GltfMaterials::Find(std::optional<size_t> material) {
  const long long key = material ? static_cast<long long>(*material) : -1;
  const auto found = materials_.find(key);
  if (found != materials_.end()) return found->second;
  const Json& source = material ? document_.At("materials", *material) : kEmpty;
  std::string name = core::TextMember(source, "name");
  if (name.empty()) name = material ? "material_" + std::to_string(*material) : "default";
  return materials_.emplace(key, Read(source, name)).first->second;
}

bool GltfMaterials::DecodeImage(size_t image, core::Image* read) {
  std::string file;
  try {
    const std::optional<std::string> bytes = document_.ImageBytes(image, &file);
    if (!bytes) return ReadTextureFile(document_.path().parent_path(), file, &findings_, read);
    core::ImageReadOptions options;
    options.max_side = kMaxTextureSide;
    *read = core::DecodeImage(*bytes, "images[" + std::to_string(image) + "]", options);
    return true;
  } catch (const core::Error& error) {
    findings_.Add(core::Severity::kWarning, "texture-unreadable",
                  std::string("a texture is ignored: ") + error.what(), "");
    return false;
  }
}

int GltfMaterials::ReadImage(size_t image, bool opaque) {
  const auto [entry, fresh] = textures_.try_emplace({image, opaque}, -1);
  if (!fresh) return entry->second;
  core::Image read;
  if (!DecodeImage(image, &read)) return -1;
  entry->second = static_cast<int>(mesh_.textures.size());
  mesh_.textures.push_back(opaque ? WithoutAlpha(read) : std::move(read));
  return entry->second;
}

std::optional<size_t> GltfMaterials::ImageOf(const Json& texture) {
  std::optional<size_t> image = IndexMember(texture, "source");
  if (const Json* webp = Extension(texture, "EXT_texture_webp")) {
    if (const auto source = IndexMember(*webp, "source")) image = source;
  }
  if (image) return image;
  const Json* basis = Extension(texture, "KHR_texture_basisu");
  findings_.Add(core::Severity::kWarning, "texture-unreadable",
                basis != nullptr ? "a texture is ignored: it is KTX2 (Basis Universal)"
                                 : "a texture is ignored: it names no supported image",
                "export with PNG or JPEG textures (gltf-transform, or Blender)");
  return std::nullopt;
}

void GltfMaterials::ReadTexture(const Json& info, GltfMaterial* material, core::Material* target) {
  const std::optional<size_t> index = IndexMember(info, "index");
  if (!index) return;
  const Json& texture = document_.At("textures", *index);
  const std::optional<size_t> image = ImageOf(texture);
  if (!image) return;
  target->texture = ReadImage(*image, material->opaque);
  PlaceCoordinates(info, material);
  if (const auto sampler = IndexMember(texture, "sampler")) {
    const Json& wrap = document_.At("samplers", *sampler);
    material->wraps = core::NumberMember(wrap, "wrapS", 10497) == 10497 &&
                      core::NumberMember(wrap, "wrapT", 10497) == 10497;
  }
}

int GltfMaterials::ReadMap(const Json& info, int channel, GltfMaterial* material, bool* placed) {
  const std::optional<size_t> index = IndexMember(info, "index");
  const Json* const textures = core::FindMember(document_.root(), "textures");
  if (!index || textures == nullptr || !textures->is_array() || *index >= textures->size()) {
    return -1;
  }
  GltfMaterial own;
  PlaceCoordinates(info, &own);
  const bool same = own.texcoord == material->texcoord && own.uv_turn == material->uv_turn &&
                    own.uv_offset == material->uv_offset;
  if (*placed && !same) return -1;  // one set of coordinates is kept
  const std::optional<size_t> image = ImageOf(document_.At("textures", *index));
  if (!image) return -1;
  const auto [entry, fresh] = maps_.try_emplace({*image, channel}, -1);
  core::Image read;
  if (fresh && DecodeImage(*image, &read)) {
    entry->second = static_cast<int>(look_.images.size());
    look_.images.push_back(channel >= 0 ? ChannelOf(read, channel) : WithoutAlpha(read));
  }
  if (entry->second < 0 || *placed) return entry->second;
  material->texcoord = own.texcoord;
  material->uv_turn = own.uv_turn;
  material->uv_offset = own.uv_offset;
  *placed = true;
  return entry->second;
}

void GltfMaterials::ReadLook(const Json& source, bool textured, GltfMaterial* material) {
  PbrMaterial look;
  const Json& pbr = ObjectMember(source, "pbrMetallicRoughness");
  const Json& reflection = ObjectMember(pbr, "metallicRoughnessTexture");
  const Json& normals = ObjectMember(source, "normalTexture");
  const bool stated = core::FindMember(pbr, "metallicFactor") != nullptr ||
                      core::FindMember(pbr, "roughnessFactor") != nullptr || !reflection.empty() ||
                      !normals.empty();
  if (stated) {
    // Factors that the file leaves out are 1 by the specification.
    const auto share = [&](const char* key) {
      return static_cast<float>(std::clamp(core::NumberMember(pbr, key, 1.0), 0.0, 1.0));
    };
    look.metallic = share("metallicFactor");
    look.roughness = share("roughnessFactor");
    look.normal_scale = static_cast<float>(core::NumberMember(normals, "scale", 1.0));
    bool placed = textured;
    look.roughness_map = ReadMap(reflection, 1, material, &placed);
    look.metallic_map = ReadMap(reflection, 2, material, &placed);
    look.normal_map = ReadMap(normals, -1, material, &placed);
    states_look_ = true;
  }
  look_.materials.push_back(look);
  SayUnreadMaps(source, look);
}

void GltfMaterials::SayUnreadMaps(const Json& source, const PbrMaterial& look) {
  std::string maps;
  const auto say = [&](bool there, const char* name) {
    if (there) maps += (maps.empty() ? "" : ", ") + std::string(name);
  };
  const Json& pbr = ObjectMember(source, "pbrMetallicRoughness");
  say(core::FindMember(source, "normalTexture") != nullptr && look.normal_map < 0, "normals");
  say(core::FindMember(pbr, "metallicRoughnessTexture") != nullptr && look.roughness_map < 0,
      "metal and roughness");
  say(core::FindMember(source, "occlusionTexture") != nullptr, "occlusion");
  say(core::FindMember(source, "emissiveTexture") != nullptr, "emission");
  if (maps.empty()) return;
  findings_.Add(core::Severity::kInfo, "gltf-maps-not-read",
                "textures of the look that are not read: " + maps,
                "bake them into the base colour where they matter");
}

GltfMaterial GltfMaterials::Read(const Json& source, const std::string& name) {
  GltfMaterial material;
  core::Material target;
  target.name = name;
  const std::string mode = core::TextMember(source, "alphaMode");
  material.opaque = mode.empty() || mode == "OPAQUE";
  const Json& pbr = ObjectMember(source, "pbrMetallicRoughness");
  const Json* glossy = Extension(source, "KHR_materials_pbrSpecularGlossiness");
  const Json& colors = glossy != nullptr ? *glossy : pbr;
  target.base_color = Factor(colors, glossy != nullptr ? "diffuseFactor" : "baseColorFactor");
  ReadTexture(ObjectMember(colors, glossy != nullptr ? "diffuseTexture" : "baseColorTexture"),
              &material, &target);
  // A purely emissive surface is visible by its emission.
  const bool black = target.base_color.head<3>().maxCoeff() < 0.01f;
  const Json& glow = ObjectMember(source, "emissiveTexture");
  const std::vector<double> glow_factor = NumbersMember(source, "emissiveFactor", {0, 0, 0});
  if (black && *std::max_element(glow_factor.begin(), glow_factor.end()) > 0.0) {
    for (int k = 0; k < 3; ++k) {
      target.base_color[k] = ToSrgb(static_cast<float>(glow_factor[static_cast<size_t>(k)]));
    }
    target.texture = -1;
    ReadTexture(glow, &material, &target);
    findings_.Add(
        core::Severity::kInfo, "gltf-emission-as-color",
        "material '" + name + "' is black and emissive: its emission is used as its colour",
        "give it a base colour in the file");
  }
  if (material.opaque) {
    target.base_color.w() = 1.0f;
  } else if (mode == "MASK" && target.texture < 0) {
    const bool kept = target.base_color.w() >= core::NumberMember(source, "alphaCutoff", 0.5);
    target.base_color.w() = kept ? 1.0f : 0.0f;
  }
  ReadLook(source, target.texture >= 0, &material);
  material.index = static_cast<int>(mesh_.materials.size());
  mesh_.materials.push_back(target);
  return material;
}

}  // namespace simwright::assets
