#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::assets {

// An OBJ rewritten so that Assimp 5.2 reads all of it. Assimp fails on points and lines in one
// group with faces (its validation refuses the file), partially coloured vertices (it shifts the
// colours), material names with spaces, and libraries in other folders.
struct PreparedObj {
  std::string text;                    // "usemtl mK" names materials[K]; no mtllib
  std::vector<std::string> materials;  // names in the file, in order of first use
  std::vector<std::string> libraries;  // names in its mtllib lines
  bool has_colors = false;             // "v x y z r g b"
  bool colors_in_bytes = false;        // a colour exceeds 1: the range is [0, 255]
  bool has_surfaces = false;           // has free-form curves and surfaces, which are ignored
};

PreparedObj PrepareObj(std::string_view text);

}  // namespace simwright::assets
