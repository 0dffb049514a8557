#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/json.h"

namespace simwright::assets {

// A glTF 2.0 under construction: its JSON and its one buffer, in which everything is aligned to 4
// bytes.
class GlbBuffer {
 public:
  core::OrderedJson root;

  // Add an accessor of floats, `components` per element (2 to 4), or of indices; return its index.
  // `bounds` adds min and max, which positions need.
  std::size_t AddFloats(const std::vector<float>& values, std::size_t components, bool bounds);
  std::size_t AddIndices(const std::vector<std::uint32_t>& indices);
  // Adds an embedded image, and a texture of it; returns the texture's index. The same bytes are
  // stored once.
  std::size_t AddPngTexture(const std::string& png);

  // Returns the file. Throws core::Error beyond 4 GiB, the limit of the format.
  std::string Glb() const;

 private:
  // Adds a buffer view; `target`: 34962 for vertices, 34963 for indices, 0 for none.
  std::size_t AddView(const char* data, std::size_t size, int target);

  std::string buffer_;
  std::vector<std::string> pngs_;  // by texture
};

}  // namespace simwright::assets
