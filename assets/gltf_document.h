#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"

namespace simwright::assets {

// A glTF 2.0 file (.gltf or .glb) with its buffers. It decodes numbers in every storage format of
// the specification. All members throw core::Error, naming the location, for an inconsistent file.
class GltfDocument {
 public:
  // Reads the file and its buffers, which are embedded or lie beside it.
  explicit GltfDocument(const std::filesystem::path& path);

  const core::Json& root() const { return root_; }
  const std::filesystem::path& path() const { return path_; }

  // Returns element `index` of a top-level list ("meshes"), an object.
  const core::Json& At(const char* list, size_t index) const;

  // Returns an accessor's elements in sequence, `components` numbers each; normalised integers are
  // converted and sparse values substituted.
  std::vector<float> Floats(size_t accessor, size_t components) const;
  // Returns indices of vertices or joints, `components` per element.
  std::vector<std::uint32_t> Integers(size_t accessor, size_t components) const;
  size_t CountOf(size_t accessor) const;
  // Returns the components per element of the accessor: 3 for "VEC3".
  size_t ComponentsOf(size_t accessor) const;

  std::string_view BufferView(size_t index) const;
  // Returns an image's bytes from a buffer or a data URI. Returns nothing if the image is a file,
  // and writes its name to `file`.
  std::optional<std::string> ImageBytes(size_t image, std::string* file) const;

  [[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") const;

 private:
  void ReadContainer(std::string bytes);
  void RequireVersion() const;
  void ReadBuffers();
  std::string BytesOfUri(const std::string& uri, const std::string& what) const;
  std::vector<double> Numbers(size_t accessor, size_t components) const;
  void PutSparse(const core::Json& accessor, size_t components, int type, bool normalized,
                 std::vector<double>* numbers) const;

  std::filesystem::path path_;
  core::Json root_;
  std::string binary_;                // the GLB's embedded buffer
  std::vector<std::string> buffers_;  // by index
};

// Returns a member that is an index, if present.
std::optional<size_t> IndexMember(const core::Json& object, const char* name);
// Returns a member of `count` numbers, or `otherwise`.
std::vector<double> NumbersMember(const core::Json& object, const char* name,
                                  const std::vector<double>& otherwise);
// Returns the extension object of `object`, or null.
const core::Json* Extension(const core::Json& object, const char* name);

}  // namespace simwright::assets
