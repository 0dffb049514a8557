#pragma once

#include <string>
#include <string_view>

namespace simwright::assets {

// The metadata in a COLLADA file's <asset>.
struct DaeHead {
  char up = 0;  // 'x', 'y', 'z', or 0 without <up_axis>
  // The elements that Assimp does not import: "controllers" (skins), "animations", "physics" ...
  std::string unread;
};

DaeHead ReadDaeHead(std::string_view text);

}  // namespace simwright::assets
