#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::assets {

// An attribute to decode from KHR_draco_mesh_compression.
struct DracoAttribute {
  std::uint32_t unique_id = 0;  // in the compressed mesh
  size_t components = 0;
};

struct DracoMesh {
  std::vector<std::uint32_t> indices;                // of triangles
  std::map<std::string, std::vector<float>> values;  // by name, `components` per vertex
  size_t vertices = 0;
};

// Decompresses a mesh with Google's Draco. Throws core::Error, naming `where`, if it is damaged or
// lacks an attribute.
DracoMesh DecodeDraco(std::string_view bytes,
                      const std::map<std::string, DracoAttribute>& attributes,
                      const std::string& where);

}  // namespace simwright::assets
