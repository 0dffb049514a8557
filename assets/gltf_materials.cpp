#include "assets/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::assets {
using core::Json;
namespace {

core::Image WithoutAlpha(const core::Image& image) {
  if (image.channels != 4) return image;
  core::Image opaque(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::copy_n(image.At(x, y), 3, opaque.At(x, y));
  }
  return opaque;
}

Eigen::Vector4f Factor(const Json& object, const char* name) {
  const std::vector<double> read = NumbersMember(object, name, {1, 1, 1, 1});
  Eigen::Vector4f color;
  for (int k = 0; k < 4; ++k) {
    color[k] = std::clamp(static_cast<float>(read[static_cast<size_t>(k)]), 0.0f, 1.0f);
  }
  for (int k = 0; k < 3; ++k) color[k] = ToSrgb(color[k]);
  return color;
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

int GltfMaterials::ReadImage(size_t image, bool opaque) {
  const auto [entry, fresh] = textures_.try_emplace({image, opaque}, -1);
  if (!fresh) return entry->second;
  std::string file;
  core::Image read;
  try {
    const std::optional<std::string> bytes = document_.ImageBytes(image, &file);
    if (bytes) {
      core::ImageReadOptions options;
      options.max_side = kMaxTextureSide;
      read = core::DecodeImage(*bytes, "images[" + std::to_string(image) + "]", options);
    } else {
      if (!ReadTextureFile(document_.path().parent_path(), file, &findings_, &read)) return -1;
    }
  } catch (const core::Error& error) {
    findings_.Add(core::Severity::kWarning, "texture-unreadable",
                  std::string("a texture is ignored: ") + error.what(), "");
    return -1;
  }
  entry->second = static_cast<int>(mesh_.textures.size());
  mesh_.textures.push_back(opaque ? WithoutAlpha(read) : std::move(read));
  return entry->second;
}

void GltfMaterials::ReadTexture(const Json& info, GltfMaterial* material, core::Material* target) {
  const std::optional<size_t> index = IndexMember(info, "index");
  if (!index) return;
  const Json& texture = document_.At("textures", *index);
  std::optional<size_t> image = IndexMember(texture, "source");
  if (const Json* webp = Extension(texture, "EXT_texture_webp")) {
    if (const auto source = IndexMember(*webp, "source")) image = source;
  }
  if (!image) {
    const Json* basis = Extension(texture, "KHR_texture_basisu");
    findings_.Add(core::Severity::kWarning, "texture-unreadable",
                  basis != nullptr ? "a texture is ignored: it is KTX2 (Basis Universal)"
                                   : "a texture is ignored: it names no supported image",
                  "export with PNG or JPEG textures (gltf-transform, or Blender)");
    return;
  }
  target->texture = ReadImage(*image, material->opaque);
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
  if (const auto sampler = IndexMember(texture, "sampler")) {
    const Json& wrap = document_.At("samplers", *sampler);
    material->wraps = core::NumberMember(wrap, "wrapS", 10497) == 10497 &&
                      core::NumberMember(wrap, "wrapT", 10497) == 10497;
  }
}

void GltfMaterials::SayUnreadMaps(const Json& source) {
  std::string maps;
  const auto say = [&](bool there, const char* name) {
    if (there) maps += (maps.empty() ? "" : ", ") + std::string(name);
  };
  const Json& pbr = ObjectMember(source, "pbrMetallicRoughness");
  say(core::FindMember(source, "normalTexture") != nullptr, "normals");
  say(core::FindMember(pbr, "metallicRoughnessTexture") != nullptr, "metal and roughness");
  say(core::FindMember(source, "occlusionTexture") != nullptr, "occlusion");
  say(core::FindMember(source, "emissiveTexture") != nullptr, "emission");
  if (maps.empty()) return;
  findings_.Add(core::Severity::kInfo, "gltf-maps-not-read",
                "only base colour textures are read; ignored: " + maps,
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
  SayUnreadMaps(source);
  material.index = static_cast<int>(mesh_.materials.size());
  mesh_.materials.push_back(target);
  return material;
}

}  // namespace simwright::assets
