#include "assets/gltf_extensions.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"

namespace simwright::assets {
using core::Json;
namespace {

constexpr std::string_view kRead[] = {
    "KHR_draco_mesh_compression", "KHR_mesh_quantization", "KHR_texture_transform",
    "KHR_materials_unlit",        "EXT_texture_webp",      "KHR_materials_pbrSpecularGlossiness"};

bool IsRead(std::string_view name) {
  return std::find(std::begin(kRead), std::end(kRead), name) != std::end(kRead);
}

// Returns true for extensions that affect appearance, lights or metadata, not geometry.
bool AffectsAppearanceOnly(std::string_view name) {
  for (const std::string_view start :
       {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
        "EXT_lights_", "KHR_xmp", "KHR_animation_", "MSFT_packing_", "AGI_", "ADOBE_materials_",
        "MPEG_", "KHR_audio", "EXT_lights"}) {
    if (name.starts_with(start)) return true;
  }
  return false;
}

std::vector<std::string> Names(const Json& root, const char* member) {
  std::vector<std::string> names;
  const auto list = root.find(member);
  if (list == root.end() || !list->is_array()) return names;
  for (const Json& name : *list) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

std::string RemedyFor(std::string_view name) {
  if (name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression") {
    return "it is compressed by meshopt: decompress it with 'gltfpack -i IN.glb -o OUT.glb' "
           "(without -c)";
  }
  if (name == "EXT_mesh_gpu_instancing") {
    return "make its instances real (gltf-transform, or Blender: Make Instances Real)";
  }
  return "open it in Blender and export it as GLB without that extension";
}

}  // namespace

void RequireReadableExtensions(const Json& root, const std::string& where) {
  for (const std::string& name : Names(root, "extensionsRequired")) {
    if (IsRead(name) || AffectsAppearanceOnly(name)) continue;
    throw core::Error("requires the glTF extension " + name + ", which is not read", where,
                      RemedyFor(name));
  }
}

std::vector<std::string> UnreadExtensions(const Json& root) {
  std::vector<std::string> unread;
  for (const char* member : {"extensionsUsed", "extensionsRequired"}) {
    for (const std::string& name : Names(root, member)) {
      if (!IsRead(name) && std::find(unread.begin(), unread.end(), name) == unread.end()) {
        unread.push_back(name);
      }
    }
  }
  return unread;
}

}  // namespace simwright::assets
