#include "assets/usd_material.h"

#include <cmath>

#include "core/error.h"

namespace simwright::assets {
namespace {

// A component of sRGB in [0, 1] as linear light (IEC 61966-2-1).
double Linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

Eigen::Vector3d LinearColor(const core::Material& material) {
  return {Linear(material.base_color.x()), Linear(material.base_color.y()),
          Linear(material.base_color.z())};
}

const std::string& FileOf(const std::vector<std::string>& files, int index,
                          const std::string& material) {
  if (index < 0 || static_cast<size_t>(index) >= files.size()) {
    throw core::Error(
        "names image " + std::to_string(index) + " of " + std::to_string(files.size()),
        "material '" + material + "'");
  }
  return files[static_cast<size_t>(index)];
}

// The shaders of one material, and the paths by which they refer to each other.
class Network {
 public:
  Network(const std::string& parent, const std::string& name)
      : material_("Material", name), path_(parent + "/" + name), surface_("Shader", "surface") {
    surface_.Set("uniform token info:id", "\"UsdPreviewSurface\"");
  }

  UsdPrim& surface() { return surface_; }

  // Adds a texture whose output feeds an input of the surface. `output`: "float3 outputs:rgb".
  UsdPrim& Texture(const std::string& input, const std::string& name, const std::string& file,
                   const std::string& color_space, const std::string& output) {
    has_coordinates_ = true;
    UsdPrim texture("Shader", name);
    texture.Set("uniform token info:id", "\"UsdUVTexture\"")
        .Set("asset inputs:file", UsdAsset(file))
        .Set("token inputs:sourceColorSpace", "\"" + color_space + "\"")
        .Set("token inputs:wrapS", "\"repeat\"")
        .Set("token inputs:wrapT", "\"repeat\"")
        .Set("float2 inputs:st.connect", "<" + path_ + "/coordinates.outputs:result>")
        .Declare(output);
    surface_.Set(input + ".connect",
                 "<" + path_ + "/" + name + "." + output.substr(output.find(' ') + 1) + ">");
    textures_.push_back(std::move(texture));
    return textures_.back();
  }

  UsdPrim Finish() {
    surface_.Declare("token outputs:surface");
    material_.Set("token outputs:surface.connect", "<" + path_ + "/surface.outputs:surface>");
    material_.Add(std::move(surface_));
    if (has_coordinates_) {
      material_.Add(UsdPrim("Shader", "coordinates"))
          .Set("uniform token info:id", "\"UsdPrimvarReader_float2\"")
          .Set("string inputs:varname", "\"st\"")
          .Declare("float2 outputs:result");
    }
    for (UsdPrim& texture : textures_) material_.Add(std::move(texture));
    return std::move(material_);
  }

 private:
  UsdPrim material_;
  std::string path_;
  UsdPrim surface_;
  std::vector<UsdPrim> textures_;
  bool has_coordinates_ = false;
};

void AddReflection(const PbrMaterial& pbr, const std::string& name, const UsdTextureFiles& files,
                   Network* network) {
  const auto add = [&](const std::string& input, float factor, int map) {
    if (map < 0) {
      network->surface().Set("float inputs:" + input, UsdFloat(factor));
      return;
    }
    const std::string scale = UsdFloat(factor);
    network
        ->Texture("float inputs:" + input, input + "_map", FileOf(files.maps, map, name), "raw",
                  "float outputs:r")
        .Set("float4 inputs:scale", "(" + scale + ", " + scale + ", " + scale + ", 1)");
  };
  add("metallic", pbr.metallic, pbr.metallic_map);
  add("roughness", pbr.roughness, pbr.roughness_map);
  if (pbr.normal_map < 0) return;
  const std::string scale = UsdFloat(2.0 * pbr.normal_scale), bias = UsdFloat(-pbr.normal_scale);
  network
      ->Texture("normal3f inputs:normal", "normal_map", FileOf(files.maps, pbr.normal_map, name),
                "raw", "float3 outputs:rgb")
      .Set("float4 inputs:scale", "(" + scale + ", " + scale + ", 2, 1)")
      .Set("float4 inputs:bias", "(" + bias + ", " + bias + ", -1, 0)");
}

}  // namespace

UsdPrim UsdMaterial(const std::string& parent, const std::string& name,
                    const core::Material& material, const PbrMaterial* pbr,
                    const UsdTextureFiles& files) {
  Network network(parent, name);
  const Eigen::Vector3d color = LinearColor(material);
  const double opacity = material.base_color.w();
  if (material.texture >= 0) {
    UsdPrim& texture = network.Texture("color3f inputs:diffuseColor", "base_color",
                                       FileOf(files.textures, material.texture, name), "sRGB",
                                       "float3 outputs:rgb");
    const std::string scale = UsdFloats(color);
    texture.Set("float4 inputs:scale", scale.substr(0, scale.size() - 1) + ", 1)");
  } else {
    network.surface().Set("color3f inputs:diffuseColor", UsdFloats(color));
  }
  if (opacity < 1.0) network.surface().Set("float inputs:opacity", UsdFloat(opacity));
  AddReflection(pbr == nullptr ? PbrMaterial() : *pbr, name, files, &network);
  return network.Finish();
}

UsdPrim UsdPhysicsMaterial(const std::string& name, const UsdContact& contact) {
  UsdPrim material("Material", name);
  material.Apply("PhysicsMaterialAPI")
      .Set("float physics:staticFriction", UsdFloat(contact.friction))
      .Set("float physics:dynamicFriction", UsdFloat(contact.friction))
      .Set("float physics:restitution", UsdFloat(contact.restitution));
  if (contact.rolling_friction > 0.0) {
    material.Apply("NewtonMaterialAPI")
        .Set("float newton:rollingFriction", UsdFloat(contact.rolling_friction));
  }
  return material;
}

}  // namespace simwright::assets
