#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base64.h"

namespace simwright::assets {

// Builds a small glTF: accessors one after the other in one buffer.
class GltfBuilder {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}},
                         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}}};

  template <typename Value>
  int Add(const std::vector<Value>& values, int component_type, const char* type, int components,
          bool normalized = false) {
    const int view =
        AddBytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
    nlohmann::json accessor = {{"bufferView", view},
                               {"componentType", component_type},
                               {"count", values.size() / static_cast<size_t>(components)},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  int AddFloats(const std::vector<float>& values, const char* type, int components) {
    return Add(values, 5126, type, components);
  }
  int AddIndices(const std::vector<std::uint16_t>& values) {
    return Add(values, 5123, "SCALAR", 1);
  }

  int AddBytes(const std::string& bytes) {
    while (buffer_.size() % 4 != 0) buffer_.push_back('\0');
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    buffer_ += bytes;
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  // A base colour texture of material 0 from a PNG inside the buffer.
  nlohmann::json& AddTexture(const std::string& png) {
    root["images"].push_back({{"bufferView", AddBytes(png)}, {"mimeType", "image/png"}});
    root["textures"].push_back({{"source", root["images"].size() - 1}});
    root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
        root["textures"].size() - 1;
    return root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  }

  std::string Gltf() {
    root["buffers"] = {{{"byteLength", buffer_.size()},
                        {"uri", "data:application/octet-stream;base64," + core::Base64(buffer_)}}};
    return root.dump();
  }
  std::string GltfWithBuffer(const std::string& uri) {
    root["buffers"] = {{{"byteLength", buffer_.size()}, {"uri", uri}}};
    return root.dump();
  }
  std::string Glb() {
    root["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string text = root.dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    std::string binary = buffer_;
    while (binary.size() % 4 != 0) binary.push_back('\0');
    std::string glb =
        "glTF" + Uint(2) + Uint(static_cast<std::uint32_t>(28 + text.size() + binary.size()));
    glb += Uint(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
    return glb + Uint(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
  }
  const std::string& buffer() const { return buffer_; }

 private:
  static std::string Uint(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
  }
  std::string buffer_;
};

}  // namespace simwright::assets
