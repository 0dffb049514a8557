#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace simwright::assets {

// A material of an OBJ's library, as far as it is kept.
struct MtlMaterial {
  std::string name;
  Eigen::Vector3f diffuse{0.8f, 0.8f, 0.8f};  // Kd, sRGB as viewers take it
  bool has_diffuse = false;
  float opacity = 1.0f;  // d, else 1 - Tr
  std::string texture;   // map_Kd, else map_Ka; as written
  Eigen::Vector2f uv_scale{1.0f, 1.0f};   // its -s
  Eigen::Vector2f uv_offset{0.0f, 0.0f};  // its -o
  bool clamp = false;                     // its -clamp on
  std::set<std::string> unread;           // statements that change the look and are not read
};

// The materials of a library, in order; of two with one name the later stays. Lines that are not
// understood are passed over: libraries come with statements of many programs.
std::vector<MtlMaterial> ReadMtl(std::string_view text);

}  // namespace simwright::assets
