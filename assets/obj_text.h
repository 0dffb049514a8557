#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::assets {

// An OBJ rewritten so that Assimp 5.2 reads all of it. What that reader does not: points and lines
// in one group with faces (its validation refuses the file), vertices of which some have colours
// (it shifts the colours), names of materials with spaces, libraries that lie elsewhere.
struct ObjText {
  std::string text;                     // "usemtl mK" names materials[K]; no mtllib
  std::vector<std::string> materials;   // as the file names them, in order of first use
  std::vector<std::string> libraries;   // what its mtllib lines say
  bool has_colors = false;              // "v x y z r g b"
  bool colors_in_bytes = false;         // a colour above 1: they are of [0, 255]
  bool has_surfaces = false;            // free-form curves and surfaces, which are left out
};

ObjText PrepareObj(std::string_view text);

}  // namespace simwright::assets
