#pragma once

#include <string>
#include <string_view>

namespace simwright::assets {

// What a COLLADA file says of itself in <asset>.
struct DaeHead {
  char up = 0;  // 'x', 'y', 'z', or 0 without <up_axis>
  // Elements that Assimp does not hand on: "controllers" (skins), "animations", "physics" ...
  std::string unread;
};

DaeHead ReadDaeHead(std::string_view text);

}  // namespace simwright::assets
