#include "assets/glb_buffer.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace simwright::assets {
namespace {

constexpr int kFloatType = 5126, kUnsignedIntType = 5125, kUnsignedShortType = 5123;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

std::string LittleEndian(std::uint32_t value) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xff);
  return bytes;
}

void PadTo4(std::string* bytes, char padding) {
  while (bytes->size() % 4 != 0) bytes->push_back(padding);
}

}  // namespace

std::size_t GlbBuffer::AddView(const char* data, std::size_t size, int target) {
  PadTo4(&buffer_, '\0');
  core::OrderedJson view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", size}};
  if (target != 0) view["target"] = target;
  buffer_.append(data, size);
  root["bufferViews"].push_back(view);
  return root["bufferViews"].size() - 1;
}

std::size_t GlbBuffer::AddFloats(const std::vector<float>& values, std::size_t components,
                                 bool bounds) {
  // The hosts are little-endian, as glTF is.
  const std::size_t view = AddView(reinterpret_cast<const char*>(values.data()),
                                   values.size() * sizeof(float), kVertexTarget);
  core::OrderedJson accessor = {{"bufferView", view},
                                {"componentType", kFloatType},
                                {"count", values.size() / components},
                                {"type", "VEC" + std::to_string(components)}};
  if (bounds) {
    for (const bool low : {true, false}) {
      core::OrderedJson corner = core::OrderedJson::array();
      for (std::size_t c = 0; c < components; ++c) {
        float bound = values[c];
        for (std::size_t i = c; i < values.size(); i += components) {
          bound = low ? std::min(bound, values[i]) : std::max(bound, values[i]);
        }
        corner.push_back(bound);
      }
      accessor[low ? "min" : "max"] = corner;
    }
  }
  root["accessors"].push_back(accessor);
  return root["accessors"].size() - 1;
}

std::size_t GlbBuffer::AddIndices(const std::vector<std::uint32_t>& indices) {
  const std::uint32_t largest = *std::max_element(indices.begin(), indices.end());
  // 65535 restarts primitives and is no index.
  const bool is_short = largest < std::numeric_limits<std::uint16_t>::max();
  std::string bytes;
  for (const std::uint32_t index : indices) {
    bytes += LittleEndian(index).substr(0, is_short ? 2 : 4);
  }
  const std::size_t view = AddView(bytes.data(), bytes.size(), kIndexTarget);
  root["accessors"].push_back({{"bufferView", view},
                               {"componentType", is_short ? kUnsignedShortType : kUnsignedIntType},
                               {"count", indices.size()},
                               {"type", "SCALAR"}});
  return root["accessors"].size() - 1;
}

std::size_t GlbBuffer::AddPngTexture(const std::string& png) {
  const auto known = std::find(pngs_.begin(), pngs_.end(), png);
  if (known != pngs_.end()) return static_cast<std::size_t>(known - pngs_.begin());
  const std::size_t view = AddView(png.data(), png.size(), 0);
  root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  if (!root.contains("samplers")) {
    // Linear filtering, with mipmaps, repeated.
    root["samplers"].push_back(
        {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}});
  }
  root["textures"].push_back({{"sampler", 0}, {"source", root["images"].size() - 1}});
  pngs_.push_back(png);
  return pngs_.size() - 1;
}

std::string GlbBuffer::Glb() const {
  core::OrderedJson json = root;
  std::string binary = buffer_;
  PadTo4(&binary, '\0');
  if (!binary.empty()) json["buffers"].push_back({{"byteLength", binary.size()}});
  std::string text = core::JsonLine(json, core::InvalidUtf8::kReplace);
  PadTo4(&text, ' ');
  const std::size_t size = 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw core::Error("the model is larger than 4 GiB, the limit of GLB", "",
                      "simplify the mesh or its textures");
  }
  const auto chunk = [](const std::string& content, const std::string& type) {
    return LittleEndian(static_cast<std::uint32_t>(content.size())) + type + content;
  };
  std::string glb = "glTF" + LittleEndian(2) + LittleEndian(static_cast<std::uint32_t>(size));
  glb += chunk(text, "JSON");
  if (!binary.empty()) glb += chunk(binary, std::string("BIN") + '\0');
  return glb;
}

}  // namespace simwright::assets
