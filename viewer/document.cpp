#include "viewer/document.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "core/content_hash.h"
#include "viewer/mesh_packing.h"

namespace simwright::viewer {
namespace {

constexpr int kLargestTexture = 2048;  // pixels per side
constexpr int kJpegQuality = 90;

Buffer Encoded(const core::Image& image) {
  if (image.channels == 3) return {core::EncodeJpeg(image, kJpegQuality), "image/jpeg"};
  return {core::EncodePng(image), "image/png"};
}

core::OrderedJson MaterialJson(const core::Material& material, int texture) {
  return {{"color",
           {material.base_color.x(), material.base_color.y(), material.base_color.z(),
            material.base_color.w()}},
          {"texture", texture}};
}

}  // namespace

DocumentBuilder::DocumentBuilder(const std::string& kind, const std::string& title) {
  document_.manifest = {{"format", 1},
                        {"kind", kind},
                        {"title", title},
                        {"findings", core::OrderedJson::array()},
                        {"meshes", core::OrderedJson::array()},
                        {"models", core::OrderedJson::array()},
                        {"worlds", core::OrderedJson::array()}};
}

int DocumentBuilder::AddBuffer(Buffer buffer) {
  document_.buffers.push_back(std::move(buffer));
  return static_cast<int>(document_.buffers.size()) - 1;
}

int DocumentBuilder::AddTexture(const core::Image& image) {
  if (image.empty()) return -1;
  const std::string key =
      core::ContentHash({reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size()}) +
      std::to_string(image.width);
  const auto found = textures_.find(key);
  if (found != textures_.end()) return found->second;
  const int side = std::max(image.width, image.height);
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(static_cast<double>(length) * kLargestTexture / side));
  };
  const int index =
      AddBuffer(side <= kLargestTexture
                    ? Encoded(image)
                    : Encoded(core::Resize(image, scaled(image.width), scaled(image.height))));
  textures_[key] = index;
  return index;
}

int DocumentBuilder::AddPacked(core::OrderedJson mesh, std::string bytes) {
  const std::string key = core::ContentHash(bytes) + core::JsonLine(mesh);
  const auto found = meshes_.find(key);
  if (found != meshes_.end()) return found->second;
  mesh["buffer"] = AddBuffer({std::move(bytes), "application/octet-stream"});
  document_.manifest["meshes"].push_back(std::move(mesh));
  const int index = static_cast<int>(document_.manifest["meshes"].size()) - 1;
  meshes_[key] = index;
  return index;
}

int DocumentBuilder::AddMesh(const core::TexturedMesh& mesh, const std::string& where) {
  core::RequireValid(mesh, where);
  PackedMesh packed = PackMesh(mesh);
  core::OrderedJson json = {{"vertices", packed.vertices},
                            {"triangles", packed.triangles},
                            {"uvs", packed.has_uvs},
                            {"groups", core::OrderedJson::array()},
                            {"materials", core::OrderedJson::array()}};
  for (const TriangleGroup& group : packed.groups) {
    json["groups"].push_back({group.first, group.count, group.material});
  }
  std::vector<core::Material> materials = mesh.materials;
  if (materials.empty()) materials.emplace_back();
  for (const core::Material& material : materials) {
    const bool textured = packed.has_uvs && material.texture >= 0 &&
                          material.texture < static_cast<int>(mesh.textures.size());
    const int texture =
        textured ? AddTexture(mesh.textures[static_cast<std::size_t>(material.texture)]) : -1;
    json["materials"].push_back(MaterialJson(material, texture));
  }
  return AddPacked(std::move(json), std::move(packed.bytes));
}

int DocumentBuilder::AddMesh(const core::TriangleMesh& mesh, const std::string& where) {
  core::TexturedMesh plain;
  plain.mesh = mesh;
  return AddMesh(plain, where);
}

int DocumentBuilder::AddModel(core::OrderedJson model) {
  document_.manifest["models"].push_back(std::move(model));
  return static_cast<int>(document_.manifest["models"].size()) - 1;
}

int DocumentBuilder::AddWorld(core::OrderedJson world) {
  document_.manifest["worlds"].push_back(std::move(world));
  return static_cast<int>(document_.manifest["worlds"].size()) - 1;
}

core::OrderedJson PoseNumbers(const Eigen::Isometry3d& pose) {
  core::OrderedJson numbers = core::OrderedJson::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

core::OrderedJson VectorNumbers(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

core::OrderedJson FactsJson(const Facts& facts) {
  core::OrderedJson list = core::OrderedJson::array();
  for (const auto& [name, value] : facts) list.push_back(core::OrderedJson::array({name, value}));
  return list;
}

std::string Quantity(double value, const std::string& unit, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return unit.empty() ? text : text + (" " + unit);
}

}  // namespace simwright::viewer
