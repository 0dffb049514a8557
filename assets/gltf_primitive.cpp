#include "assets/gltf_primitive.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "assets/gltf_draco.h"

namespace simwright::assets {
using core::Json;
namespace {

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const Json& source, const GltfMaterial& material)
      : document_(document), source_(source), material_(material) {
    const Json* attributes = core::FindMember(source, "attributes");
    if (attributes == nullptr || !attributes->is_object()) {
      document_.Fail("a primitive has no attributes");
    }
    attributes_ = attributes;
  }

  std::optional<GltfPrimitive> Read(const std::vector<double>& weights, bool skinned) {
    const auto mode = static_cast<int>(IndexMember(source_, "mode").value_or(4));
    if (mode < 4 || mode > 6 || !IndexMember(*attributes_, "POSITION")) return std::nullopt;
    Decompress();
    ReadPositions(weights);
    ReadColors();
    ReadUvs();
    if (skinned) ReadInfluences();
    ReadTriangles(mode);
    return std::move(result_);
  }

 private:
  void Decompress();
  bool ReadFloats(const std::string& name, size_t components, std::vector<float>* values) const;
  void ReadPositions(const std::vector<double>& weights);
  void Morph(const std::vector<double>& weights);
  void ReadColors();
  void ReadUvs();
  void ReadInfluences();
  void ReadTriangles(int mode);

  const GltfDocument& document_;
  const Json& source_;
  const GltfMaterial& material_;
  const Json* attributes_ = nullptr;
  std::optional<DracoMesh> draco_;
  GltfPrimitive result_;
};

void PrimitiveReader::Decompress() {
  const Json* draco = Extension(source_, "KHR_draco_mesh_compression");
  if (draco == nullptr) return;
  const Json* ids = core::FindMember(*draco, "attributes");
  const std::optional<size_t> view = IndexMember(*draco, "bufferView");
  if (ids == nullptr || !ids->is_object() || !view) {
    document_.Fail("a Draco compressed primitive lacks its data");
  }
  std::map<std::string, DracoAttribute> wanted;
  for (const auto& [name, id] : ids->items()) {
    const std::optional<size_t> accessor = IndexMember(*attributes_, name.c_str());
    const std::optional<size_t> unique = IndexMember(*ids, name.c_str());
    if (!accessor || !unique) continue;
    wanted[name] = {static_cast<std::uint32_t>(*unique), document_.ComponentsOf(*accessor)};
  }
  draco_ = DecodeDraco(document_.BufferView(*view), wanted, document_.path().string());
}

bool PrimitiveReader::ReadFloats(const std::string& name, size_t components,
                                 std::vector<float>* values) const {
  const std::optional<size_t> accessor = IndexMember(*attributes_, name.c_str());
  if (!accessor) return false;
  if (document_.ComponentsOf(*accessor) != components) {
    document_.Fail("attribute " + name + " is of another type than the specification says");
  }
  const bool compressed = draco_ && draco_->values.contains(name);
  *values = compressed ? draco_->values.at(name) : document_.Floats(*accessor, components);
  if (!result_.positions.empty() && values->size() != components * result_.positions.size()) {
    document_.Fail("attribute " + name + " has another length than POSITION");
  }
  return true;
}

void PrimitiveReader::ReadPositions(const std::vector<double>& weights) {
  std::vector<float> values;
  ReadFloats("POSITION", 3, &values);
  for (size_t i = 0; i + 2 < values.size(); i += 3) {
    result_.positions.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  Morph(weights);
}

void PrimitiveReader::Morph(const std::vector<double>& weights) {
  const Json* targets = core::FindMember(source_, "targets");
  if (targets == nullptr || !targets->is_array()) return;
  for (size_t i = 0; i < std::min(targets->size(), weights.size()); ++i) {
    const std::optional<size_t> accessor = IndexMember((*targets)[i], "POSITION");
    if (!accessor || weights[i] == 0.0) continue;
    const std::vector<float> moved = document_.Floats(*accessor, 3);
    if (moved.size() != 3 * result_.positions.size()) {
      document_.Fail("a morph target has another length than POSITION");
    }
    for (size_t v = 0; v < result_.positions.size(); ++v) {
      result_.positions[v] +=
          weights[i] * Eigen::Vector3d(moved[3 * v], moved[3 * v + 1], moved[3 * v + 2]);
    }
  }
}

// Reads COLOR_0, which is linear light; alpha is used if the material blends.
void PrimitiveReader::ReadColors() {
  const std::optional<size_t> accessor = IndexMember(*attributes_, "COLOR_0");
  if (!accessor) return;
  const size_t components = document_.ComponentsOf(*accessor);
  std::vector<float> values;
  if (components != 3 && components != 4) document_.Fail("COLOR_0 is neither RGB nor RGBA");
  ReadFloats("COLOR_0", components, &values);
  for (size_t i = 0; i + components <= values.size(); i += components) {
    Eigen::Vector4f color(ToSrgb(values[i]), ToSrgb(values[i + 1]), ToSrgb(values[i + 2]), 1.0f);
    if (components == 4 && !material_.opaque) color[3] = values[i + 3];
    result_.colors.push_back(ToCornerColor(color));
  }
}

void PrimitiveReader::ReadUvs() {
  std::vector<float> values;
  if (!ReadFloats("TEXCOORD_" + std::to_string(material_.texcoord), 2, &values)) return;
  for (size_t i = 0; i + 1 < values.size(); i += 2) {
    result_.uvs.push_back(material_.Uv({values[i], values[i + 1]}));
  }
}

void PrimitiveReader::ReadInfluences() {
  for (int set = 0; set < 8; ++set) {
    const std::string joints = "JOINTS_" + std::to_string(set);
    std::vector<float> weights;
    const std::optional<size_t> accessor = IndexMember(*attributes_, joints.c_str());
    if (!accessor || !ReadFloats("WEIGHTS_" + std::to_string(set), 4, &weights)) return;
    std::vector<std::uint32_t> read;
    if (draco_ && draco_->values.contains(joints)) {
      for (const float value : draco_->values.at(joints)) {
        read.push_back(static_cast<std::uint32_t>(std::max(0.0f, value)));
      }
    } else {
      read = document_.Integers(*accessor, 4);
    }
    if (read.size() != weights.size()) document_.Fail(joints + " has another length than weights");
    // The sets are concatenated per vertex.
    const size_t before = result_.influences, now = before + 4;
    std::vector<std::uint32_t> all_joints;
    std::vector<float> all_weights;
    for (size_t v = 0; v < result_.positions.size(); ++v) {
      for (size_t k = 0; k < before; ++k) {
        all_joints.push_back(result_.joints[v * before + k]);
        all_weights.push_back(result_.weights[v * before + k]);
      }
      for (size_t k = 0; k < 4; ++k) {
        all_joints.push_back(read[4 * v + k]);
        all_weights.push_back(weights[4 * v + k]);
      }
    }
    result_.joints = std::move(all_joints);
    result_.weights = std::move(all_weights);
    result_.influences = now;
  }
}

void PrimitiveReader::ReadTriangles(int mode) {
  std::vector<std::uint32_t> indices;
  const std::optional<size_t> accessor = IndexMember(source_, "indices");
  if (draco_) {
    indices = draco_->indices;
    mode = 4;
  } else if (accessor) {
    indices = document_.Integers(*accessor, 1);
  } else {
    indices.resize(result_.positions.size());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  for (const std::uint32_t index : indices) {
    if (index >= result_.positions.size()) document_.Fail("an index is out of range");
  }
  if (mode == 4) {
    indices.resize(indices.size() / 3 * 3);
    result_.triangles = std::move(indices);
    return;
  }
  for (size_t i = 0; i + 2 < indices.size(); ++i) {
    const std::uint32_t first = mode == 6 ? indices[0] : indices[i + i % 2];
    const std::uint32_t second = mode == 6 ? indices[i + 1] : indices[i + 1 - i % 2];
    result_.triangles.insert(result_.triangles.end(), {first, second, indices[i + 2]});
  }
}

}  // namespace

std::optional<GltfPrimitive> ReadGltfPrimitive(const GltfDocument& document, const Json& source,
                                               const GltfMaterial& material,
                                               const std::vector<double>& weights, bool skinned) {
  return PrimitiveReader(document, source, material).Read(weights, skinned);
}

}  // namespace simwright::assets
