#include "assets/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "assets/gltf_extensions.h"
#include "assets/texture_files.h"
#include "core/base64.h"
#include "core/error.h"
#include "core/files.h"
#include "core/foreign_content.h"

namespace simwright::assets {
namespace fs = std::filesystem;
using core::Json;
namespace {

constexpr std::uint64_t kMaxGltfBytes = 4ull << 30;
constexpr size_t kMaxNumbers = 400'000'000;  // of one accessor
constexpr size_t kMaxZeros = 20'000'000;     // of one accessor without a buffer
constexpr const char* kAgain = "it is damaged or cut short: download or export it again";

std::uint32_t LittleUint(std::string_view bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  }
  return value;
}

size_t BytesOfType(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

template <typename Value>
Value GltfValueAs(const char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return value;
}

// Returns one component, normalised as in the specification (signed ones never below -1).
double Component(const char* bytes, int type, bool normalized) {
  switch (type) {
    case 5120: {
      const double value = GltfValueAs<std::int8_t>(bytes);
      return normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case 5121: {
      const double value = GltfValueAs<std::uint8_t>(bytes);
      return normalized ? value / 255.0 : value;
    }
    case 5122: {
      const double value = GltfValueAs<std::int16_t>(bytes);
      return normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case 5123: {
      const double value = GltfValueAs<std::uint16_t>(bytes);
      return normalized ? value / 65535.0 : value;
    }
    case 5125:
      return GltfValueAs<std::uint32_t>(bytes);
    default:
      return GltfValueAs<float>(bytes);
  }
}

size_t ComponentsOfType(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  return type == "MAT4" ? 16 : 0;
}

size_t SizeMember(const Json& object, const char* name, size_t otherwise) {
  return IndexMember(object, name).value_or(otherwise);
}

}  // namespace

std::optional<size_t> IndexMember(const Json& object, const char* name) {
  const Json* member = core::FindMember(object, name);
  if (member == nullptr || !member->is_number()) return std::nullopt;
  const double value = member->get<double>();
  if (!(value >= 0.0) || value > 1e15 || value != std::floor(value)) return std::nullopt;
  return static_cast<size_t>(value);
}

std::vector<double> NumbersMember(const Json& object, const char* name,
                                  const std::vector<double>& otherwise) {
  const Json* member = core::FindMember(object, name);
  if (member == nullptr || !member->is_array() || member->size() != otherwise.size()) {
    return otherwise;
  }
  std::vector<double> numbers;
  for (const Json& item : *member) {
    if (!item.is_number() || !std::isfinite(item.get<double>())) return otherwise;
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

const Json* Extension(const Json& object, const char* name) {
  const Json* extensions = core::FindMember(object, "extensions");
  return extensions == nullptr ? nullptr : core::FindMember(*extensions, name);
}

GltfDocument::GltfDocument(const fs::path& path) : path_(path) {
  ReadContainer(core::ReadFile(path, kMaxGltfBytes));
  if (!root_.is_object()) Fail("this is not a glTF file", kAgain);
  RequireVersion();
  RequireReadableExtensions(root_, path_.string());
  ReadBuffers();
}

void GltfDocument::Fail(const std::string& what, const std::string& remedy) const {
  throw core::Error(what, path_.string(), remedy.empty() ? kAgain : remedy);
}

void GltfDocument::ReadContainer(std::string bytes) {
  std::string_view text = bytes;
  if (text.starts_with("glTF")) {
    if (bytes.size() < 20) Fail("the GLB is cut short");
    const std::uint32_t version = LittleUint(bytes, 4);
    if (version != 2) {
      Fail("this is glTF " + std::to_string(version) + ", only 2.0 is read",
           "convert it (gltf-pipeline, or Blender and export as GLB)");
    }
    if (LittleUint(bytes, 8) > bytes.size()) {
      Fail("the GLB is cut short: it holds " + std::to_string(bytes.size()) + " of " +
           std::to_string(LittleUint(bytes, 8)) + " bytes");
    }
    text = {};
    for (size_t at = 12; at + 8 <= bytes.size();) {
      const size_t length = LittleUint(bytes, at);
      const std::uint32_t kind = LittleUint(bytes, at + 4);
      at += 8;
      if (length > bytes.size() - at) Fail("a chunk of the GLB is cut short");
      if (kind == 0x4E4F534A && text.empty()) text = std::string_view(bytes).substr(at, length);
      if (kind == 0x004E4942 && binary_.empty()) binary_ = bytes.substr(at, length);
      at += length + (4 - length % 4) % 4;
    }
  }
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  auto root = core::TryParseJson(text);
  if (!root) Fail("the JSON of the glTF is damaged");
  root_ = std::move(*root);
}

void GltfDocument::RequireVersion() const {
  const Json* asset = core::FindMember(root_, "asset");
  const std::string version = asset == nullptr ? "" : core::TextMember(*asset, "version");
  if (version.empty()) Fail("the glTF does not declare its version", "export it again");
  if (!version.starts_with("2.")) {
    Fail("this is glTF " + version + ", only 2.0 is read",
         "convert it (gltf-pipeline, or Blender and export as GLB)");
  }
}

const Json& GltfDocument::At(const char* list, size_t index) const {
  const Json* items = core::FindMember(root_, list);
  if (items == nullptr || !items->is_array() || index >= items->size() ||
      !(*items)[index].is_object()) {
    Fail("names " + std::string(list) + "[" + std::to_string(index) + "], which is not there");
  }
  return (*items)[index];
}

std::string GltfDocument::BytesOfUri(const std::string& uri, const std::string& what) const {
  const size_t comma = uri.find(',');
  if (uri.starts_with("data:") && comma != std::string::npos) {
    const std::string_view data = std::string_view(uri).substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) {
      auto bytes = core::FromBase64(data);
      if (!bytes) Fail("the data URI of " + what + " is not Base64");
      return std::move(*bytes);
    }
    return PercentDecoded(data);
  }
  const auto found = FindSiblingFile(path_.parent_path(), uri);
  if (!found) {
    Fail(what + " '" + uri + "' is not there", "put it beside the glTF, or use one GLB");
  }
  std::string bytes = core::ReadFile(found->path, kMaxGltfBytes);
  if (const auto foreign = core::FindForeignContent(bytes.substr(0, 1024))) {
    throw core::Error(foreign->what, found->path.string(), foreign->remedy);
  }
  return bytes;
}

void GltfDocument::ReadBuffers() {
  const Json* list = core::FindMember(root_, "buffers");
  const size_t count = list != nullptr && list->is_array() ? list->size() : 0;
  for (size_t i = 0; i < count; ++i) {
    const Json& buffer = At("buffers", i);
    const std::string uri = core::TextMember(buffer, "uri");
    const std::string what = "buffers[" + std::to_string(i) + "]";
    if (!uri.empty()) {
      buffers_.push_back(BytesOfUri(uri, what));
    } else {
      buffers_.push_back(i == 0 ? binary_ : "");
    }
  }
}

std::string_view GltfDocument::BufferView(size_t index) const {
  const Json& view = At("bufferViews", index);
  const std::string place = "bufferViews[" + std::to_string(index) + "]";
  const size_t buffer = SizeMember(view, "buffer", buffers_.size());
  if (buffer >= buffers_.size()) Fail(place + " names a buffer that is not there");
  const size_t offset = SizeMember(view, "byteOffset", 0);
  const size_t length = SizeMember(view, "byteLength", 0);
  const std::string& bytes = buffers_[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    Fail(place + " leads beyond its buffer of " + std::to_string(bytes.size()) + " bytes");
  }
  return std::string_view(bytes).substr(offset, length);
}

size_t GltfDocument::CountOf(size_t accessor) const {
  return SizeMember(At("accessors", accessor), "count", 0);
}

size_t GltfDocument::ComponentsOf(size_t accessor) const {
  return ComponentsOfType(core::TextMember(At("accessors", accessor), "type"));
}

void GltfDocument::PutSparse(const Json& accessor, size_t components, int type, bool normalized,
                             std::vector<double>* numbers) const {
  const Json* sparse = core::FindMember(accessor, "sparse");
  if (sparse == nullptr) return;
  const Json* indices = core::FindMember(*sparse, "indices");
  const Json* values = core::FindMember(*sparse, "values");
  if (indices == nullptr || values == nullptr) Fail("a sparse accessor lacks its values");
  const size_t count = SizeMember(*sparse, "count", 0);
  const int index_type = static_cast<int>(SizeMember(*indices, "componentType", 0));
  const size_t index_size = BytesOfType(index_type), size = BytesOfType(type);
  const size_t index_start = SizeMember(*indices, "byteOffset", 0);
  const size_t start = SizeMember(*values, "byteOffset", 0);
  const std::string_view index_bytes = BufferView(SizeMember(*indices, "bufferView", SIZE_MAX));
  const std::string_view bytes = BufferView(SizeMember(*values, "bufferView", SIZE_MAX));
  if (index_size == 0 || index_start > index_bytes.size() || start > bytes.size() ||
      count > (index_bytes.size() - index_start) / index_size ||
      count > (bytes.size() - start) / (size * components)) {
    Fail("a sparse accessor leads beyond its buffer");
  }
  const size_t elements = numbers->size() / components;
  for (size_t i = 0; i < count; ++i) {
    const char* index = index_bytes.data() + index_start + i * index_size;
    const double at = Component(index, index_type, false);
    if (!(at >= 0.0) || at >= static_cast<double>(elements)) {
      Fail("a sparse accessor names an element that is not there");
    }
    for (size_t k = 0; k < components; ++k) {
      (*numbers)[static_cast<size_t>(at) * components + k] =
          Component(bytes.data() + start + (i * components + k) * size, type, normalized);
    }
  }
}

std::vector<double> GltfDocument::Numbers(size_t index, size_t components) const {
  const Json& accessor = At("accessors", index);
  const std::string place = "accessors[" + std::to_string(index) + "]";
  const int type = static_cast<int>(SizeMember(accessor, "componentType", 0));
  const size_t size = BytesOfType(type);
  const size_t count = SizeMember(accessor, "count", 0);
  if (size == 0 || ComponentsOf(index) != components) {
    Fail(place + " does not have " + std::to_string(components) + " known numbers");
  }
  if (count > kMaxNumbers / components) Fail(place + " has too many elements", "decimate the mesh");
  const Json* flag = core::FindMember(accessor, "normalized");
  const bool normalized = flag != nullptr && flag->is_boolean() && flag->get<bool>();
  std::vector<double> numbers;
  if (const auto view = IndexMember(accessor, "bufferView")) {
    const std::string_view bytes = BufferView(*view);
    const size_t start = SizeMember(accessor, "byteOffset", 0);
    const size_t stride = SizeMember(At("bufferViews", *view), "byteStride", size * components);
    if (stride < size * components || start > bytes.size() ||
        (count > 0 && (bytes.size() - start < size * components ||
                       (bytes.size() - start - size * components) / stride < count - 1))) {
      Fail(place + " leads beyond its buffer");
    }
    numbers.reserve(count * components);
    for (size_t i = 0; i < count; ++i) {
      const char* element = bytes.data() + start + i * stride;
      for (size_t k = 0; k < components; ++k) {
        numbers.push_back(Component(element + k * size, type, normalized));
      }
    }
  } else {
    // Without a buffer all values are zero, except sparse values, which take space in the file.
    if (count > kMaxZeros / components) Fail(place + " has too many elements");
    numbers.assign(count * components, 0.0);
  }
  PutSparse(accessor, components, type, normalized, &numbers);
  return numbers;
}

std::vector<float> GltfDocument::Floats(size_t accessor, size_t components) const {
  const std::vector<double> numbers = Numbers(accessor, components);
  return {numbers.begin(), numbers.end()};
}

std::vector<std::uint32_t> GltfDocument::Integers(size_t accessor, size_t components) const {
  std::vector<std::uint32_t> integers;
  for (const double number : Numbers(accessor, components)) {
    if (!(number >= 0.0) || number > 4294967295.0) Fail("an index is not a non-negative integer");
    integers.push_back(static_cast<std::uint32_t>(number));
  }
  return integers;
}

std::optional<std::string> GltfDocument::ImageBytes(size_t index, std::string* file) const {
  const Json& image = At("images", index);
  if (const auto view = IndexMember(image, "bufferView")) return std::string(BufferView(*view));
  const std::string uri = core::TextMember(image, "uri");
  if (uri.starts_with("data:")) return BytesOfUri(uri, "images[" + std::to_string(index) + "]");
  *file = uri;
  return std::nullopt;
}

}  // namespace simwright::assets
