#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace simwright::assets {

// A map of a material beside its colour.
struct MtlMap {
  std::string file;      // as written; empty: none
  int channel = 0;       // its -imfchan: r, g or b
  float strength = 1.0;  // its -bm
};

// The supported part of a material of an OBJ's library.
struct MtlMaterial {
  std::string name;
  Eigen::Vector3f diffuse{0.8f, 0.8f, 0.8f};  // Kd, interpreted as sRGB as viewers do
  bool has_diffuse = false;
  float opacity = 1.0f;                            // d, otherwise 1 - Tr
  std::string texture;                             // map_Kd, otherwise map_Ka; as written
  Eigen::Vector2f uv_scale{1.0f, 1.0f};            // its -s
  Eigen::Vector2f uv_offset{0.0f, 0.0f};           // its -o
  bool clamp = false;                              // its -clamp on
  std::optional<float> metallic, roughness;        // Pm and Pr, [0, 1]
  MtlMap metallic_map, roughness_map, normal_map;  // map_Pm, map_Pr, norm
  std::set<std::string> unread;  // unsupported statements that affect the appearance
};

// Returns the materials of a library, in order; of two with the same name the later wins. Unknown
// lines are ignored: libraries contain statements of many programs.
std::vector<MtlMaterial> ReadMtl(std::string_view text);

}  // namespace simwright::assets
