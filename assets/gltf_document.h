#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace simwright::assets {

// A glTF 2.0 file (.gltf or .glb) with its buffers: numbers by the specification, whatever way they
// are stored. All members throw core::Error, naming the place, where the file breaks its own rules.
class GltfDocument {
 public:
  // Reads the file and the buffers that it names, which lie beside it or inside it.
  explicit GltfDocument(const std::filesystem::path& path);

  const nlohmann::json& root() const { return root_; }
  const std::filesystem::path& path() const { return path_; }

  // Element `index` of a top-level list ("meshes"), an object.
  const nlohmann::json& At(const char* list, size_t index) const;

  // An accessor's elements one after the other, `components` numbers each; integers are normalised
  // where it says so, sparse values are put in.
  std::vector<float> Floats(size_t accessor, size_t components) const;
  // Indices of vertices or joints; `components` of each element.
  std::vector<std::uint32_t> Integers(size_t accessor, size_t components) const;
  size_t CountOf(size_t accessor) const;
  // Components of an element of the accessor: 3 of "VEC3".
  size_t ComponentsOf(size_t accessor) const;

  std::string_view BufferView(size_t index) const;
  // A picture's bytes, from a buffer or a data URI; nothing where it is a file, whose name goes to
  // `file`.
  std::optional<std::string> ImageBytes(size_t image, std::string* file) const;

  [[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") const;

 private:
  void ReadContainer(std::string bytes);
  void RequireVersion() const;
  void ReadBuffers();
  std::string BytesOfUri(const std::string& uri, const std::string& what) const;
  std::vector<double> Numbers(size_t accessor, size_t components) const;
  void PutSparse(const nlohmann::json& accessor, size_t components, int type, bool normalized,
                 std::vector<double>* numbers) const;

  std::filesystem::path path_;
  nlohmann::json root_;
  std::string binary_;                // the GLB's own buffer
  std::vector<std::string> buffers_;  // by index
};

// The member of an object, or null.
const nlohmann::json* Member(const nlohmann::json& object, const char* name);
// A member that is an index, if it is there.
std::optional<size_t> IndexMember(const nlohmann::json& object, const char* name);
double NumberMember(const nlohmann::json& object, const char* name, double otherwise);
std::string TextMember(const nlohmann::json& object, const char* name);
// A member that is `count` numbers, else `otherwise`.
std::vector<double> NumbersMember(const nlohmann::json& object, const char* name,
                                  const std::vector<double>& otherwise);
// The object of an extension of `object`, or null.
const nlohmann::json* Extension(const nlohmann::json& object, const char* name);

}  // namespace simwright::assets
