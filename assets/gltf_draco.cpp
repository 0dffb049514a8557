#include "assets/gltf_draco.h"

#include <exception>

#include <draco/compression/decode.h>

#include "core/error.h"

namespace simwright::assets {
namespace {

constexpr size_t kMaxFaces = 20'000'000;

[[noreturn]] void Fail(const std::string& what, const std::string& where) {
  throw core::Error("its Draco compressed mesh " + what, where,
                    "export it again without compression (Blender: Compression off)");
}

std::unique_ptr<draco::Mesh> DecodeDraco(std::string_view bytes, const std::string& where) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  try {
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) Fail("is damaged: " + decoded.status().error_msg_string(), where);
    return std::move(decoded).value();
  } catch (const core::Error&) {
    throw;
  } catch (const std::exception& error) {  // out of memory from a forged count
    Fail(std::string("is damaged: ") + error.what(), where);
  }
}

}  // namespace

DracoMesh DecodeDraco(std::string_view bytes,
                      const std::map<std::string, DracoAttribute>& attributes,
                      const std::string& where) {
  const std::unique_ptr<draco::Mesh> mesh = DecodeDraco(bytes, where);
  if (mesh->num_faces() > kMaxFaces) Fail("has more than 20 million faces", where);
  DracoMesh result;
  result.vertices = mesh->num_points();
  result.indices.reserve(3 * static_cast<size_t>(mesh->num_faces()));
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh->face(f)) result.indices.push_back(point.value());
  }
  for (const auto& [name, wanted] : attributes) {
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(wanted.unique_id);
    if (attribute == nullptr || wanted.components == 0 || wanted.components > 16) {
      Fail("lacks its " + name, where);
    }
    std::vector<float>& values = result.values[name];
    values.resize(result.vertices * wanted.components);
    for (draco::PointIndex point(0); point < mesh->num_points(); ++point) {
      float* out = values.data() + point.value() * wanted.components;
      if (!attribute->ConvertValue(attribute->mapped_index(point),
                                   static_cast<std::int8_t>(wanted.components), out)) {
        Fail("has values that are not numbers", where);
      }
    }
  }
  return result;
}

}  // namespace simwright::assets
