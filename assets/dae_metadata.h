#pragma once

#include <string>
#include <string_view>

namespace simwright::assets {

// The metadata in a COLLADA file's <asset>.
struct DaeMetadata {
  char up = 0;  // 'x', 'y', 'z', or 0 without <up_axis>
  // The elements that Assimp does not import: "controllers" (skins), "animations", "physics" ...
  std::string unread;
};

DaeMetadata ReadDaeMetadata(std::string_view text);

}  // namespace simwright::assets
