#include "assets/gltf_mesh.h"

#include <algorithm>
#include <set>
#include <string>

#include "assets/gltf_document.h"
#include "assets/gltf_extensions.h"
#include "assets/gltf_materials.h"
#include "assets/gltf_primitive.h"
#include "core/error.h"

namespace simwright::assets {
using core::Json;
namespace {

constexpr size_t kMaxNodes = 1'000'000;

size_t SizeOf(const Json& root, const char* list) {
  const Json* member = core::FindMember(root, list);
  return member != nullptr && member->is_array() ? member->size() : 0;
}

std::vector<size_t> Indices(const Json& object, const char* name) {
  std::vector<size_t> indices;
  const Json* list = core::FindMember(object, name);
  if (list == nullptr || !list->is_array()) return indices;
  for (const Json& item : *list) {
    if (item.is_number_unsigned()) indices.push_back(item.get<size_t>());
  }
  return indices;
}

// Returns parent_from_node.
Eigen::Affine3d LocalTransform(const Json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  const Json* matrix = core::FindMember(node, "matrix");
  if (matrix != nullptr) {
    const std::vector<double> m =
        NumbersMember(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r) transform(r, c) = m[static_cast<size_t>(4 * c + r)];
    }
    return transform;
  }
  const std::vector<double> t = NumbersMember(node, "translation", {0, 0, 0});
  const std::vector<double> r = NumbersMember(node, "rotation", {0, 0, 0, 1});
  const std::vector<double> s = NumbersMember(node, "scale", {1, 1, 1});
  Eigen::Quaterniond turn(r[3], r[0], r[1], r[2]);
  if (!(turn.norm() > 1e-12)) turn.setIdentity();
  transform.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  transform.rotate(turn.normalized());
  transform.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  return transform;
}

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, FindingList* findings)
      : document_(path),
        findings_(*findings),
        vertices_(&raw_.mesh.mesh),
        materials_(document_, &raw_.mesh, &raw_.look, findings) {
    raw_.up = 'y';
    raw_.colors_multiply = true;
  }

  RawMesh Read() {
    ReportUnreadContent();
    const std::vector<size_t> roots = Roots();
    // All transforms are computed first: skins need those of joints anywhere.
    world_.assign(SizeOf(document_.root(), "nodes"), Eigen::Affine3d::Identity());
    Walk(roots);
    for (const size_t node : order_) AddNode(node);
    if (!any_uv_) raw_.mesh.corner_uvs.clear();
    if (!materials_.states_look()) raw_.look = {};
    if (any_outside_) {
      findings_.Add(core::Severity::kInfo, "texture-wraps",
                    "a texture that its file clamps or mirrors at its edges is repeated instead",
                    "keep its coordinates within [0, 1]");
    }
    return std::move(raw_);
  }

 private:
  void ReportUnreadContent();
  std::vector<size_t> Roots();
  void Walk(const std::vector<size_t>& roots);
  void AddNode(size_t index);
  std::vector<Eigen::Affine3d> JointTransforms(size_t skin) const;
  std::vector<double> MorphWeights(const Json& node, const Json& mesh) const;
  void Pose(const std::vector<Eigen::Affine3d>& joints, GltfPrimitive* primitive) const;
  void AddPrimitive(const GltfPrimitive& primitive, const GltfMaterial& material,
                    const Eigen::Affine3d& placed, int part);

  GltfDocument document_;
  FindingList& findings_;
  RawMesh raw_;
  VertexIndexer vertices_;
  GltfMaterials materials_;
  std::vector<Eigen::Affine3d> world_;  // world_from_node
  std::vector<size_t> order_;           // the scene's nodes
  bool any_uv_ = false, any_outside_ = false;
};

void GltfReader::ReportUnreadContent() {
  const Json& root = document_.root();
  std::string unread;
  const auto say = [&](bool there, const std::string& name) {
    if (there) unread += (unread.empty() ? "" : ", ") + name;
  };
  say(SizeOf(root, "animations") > 0, "animations");
  say(SizeOf(root, "cameras") > 0, "cameras");
  for (const std::string& name : UnreadExtensions(root)) say(true, name);
  if (!unread.empty()) {
    findings_.Add(core::Severity::kInfo, "gltf-not-read", "not read: " + unread,
                  "apply in Blender what matters and export again");
  }
  const std::vector<std::string> extensions = UnreadExtensions(root);
  if (std::find(extensions.begin(), extensions.end(), "EXT_mesh_gpu_instancing") !=
      extensions.end()) {
    findings_.Add(core::Severity::kWarning, "gltf-instances-left-out",
                  "instances by EXT_mesh_gpu_instancing are ignored: one of each is read",
                  "make them real (gltf-transform, or Blender: Make Instances Real)");
  }
}

std::vector<size_t> GltfReader::Roots() {
  const Json& root = document_.root();
  const size_t scenes = SizeOf(root, "scenes");
  if (scenes > 0) {
    const size_t chosen = IndexMember(root, "scene").value_or(0);
    if (scenes > 1) {
      findings_.Add(core::Severity::kWarning, "gltf-scenes",
                    "of " + std::to_string(scenes) + " scenes only scene " +
                        std::to_string(chosen) + ", the default, is read",
                    "export each scene as a file of its own", static_cast<double>(scenes));
    }
    return Indices(document_.At("scenes", chosen), "nodes");
  }
  // Without scenes the roots are the nodes without a parent.
  std::set<size_t> children;
  const size_t nodes = SizeOf(root, "nodes");
  for (size_t i = 0; i < nodes; ++i) {
    for (const size_t child : Indices(document_.At("nodes", i), "children")) children.insert(child);
  }
  std::vector<size_t> roots;
  for (size_t i = 0; i < nodes; ++i) {
    if (!children.contains(i)) roots.push_back(i);
  }
  return roots;
}

void GltfReader::Walk(const std::vector<size_t>& roots) {
  if (world_.size() > kMaxNodes) document_.Fail("has more than a million nodes", "join its meshes");
  std::vector<bool> seen(world_.size(), false);
  std::vector<std::pair<size_t, Eigen::Affine3d>> queue;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
    queue.emplace_back(*root, Eigen::Affine3d::Identity());
  }
  while (!queue.empty()) {
    const auto [index, parent] = queue.back();
    queue.pop_back();
    const Json& node = document_.At("nodes", index);
    if (seen[index]) document_.Fail("nodes[" + std::to_string(index) + "] has two parents");
    seen[index] = true;
    world_[index] = parent * LocalTransform(node);
    order_.push_back(index);
    std::vector<size_t> children = Indices(node, "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      queue.emplace_back(*child, world_[index]);
    }
  }
}

std::vector<Eigen::Affine3d> GltfReader::JointTransforms(size_t skin) const {
  const Json& source = document_.At("skins", skin);
  const std::vector<size_t> joints = Indices(source, "joints");
  std::vector<float> inverse;
  if (const auto accessor = IndexMember(source, "inverseBindMatrices")) {
    inverse = document_.Floats(*accessor, 16);
  }
  std::vector<Eigen::Affine3d> transforms;
  for (size_t i = 0; i < joints.size(); ++i) {
    if (joints[i] >= world_.size()) document_.Fail("a skin names a node that is not there");
    Eigen::Affine3d bind = Eigen::Affine3d::Identity();
    for (size_t k = 0; 16 * i + 15 < inverse.size() && k < 16; ++k) {
      if (k % 4 < 3) bind(static_cast<int>(k % 4), static_cast<int>(k / 4)) = inverse[16 * i + k];
    }
    transforms.push_back(world_[joints[i]] * bind);
  }
  return transforms;
}

std::vector<double> GltfReader::MorphWeights(const Json& node, const Json& mesh) const {
  for (const Json* holder : {&node, &mesh}) {
    const Json* weights = core::FindMember(*holder, "weights");
    if (weights == nullptr || !weights->is_array()) continue;
    return NumbersMember(*holder, "weights", std::vector<double>(weights->size(), 0.0));
  }
  return {};
}

void GltfReader::Pose(const std::vector<Eigen::Affine3d>& joints, GltfPrimitive* primitive) const {
  const size_t n = primitive->influences;
  for (size_t v = 0; v < primitive->positions.size() && n > 0; ++v) {
    Eigen::Vector3d posed = Eigen::Vector3d::Zero();
    double sum = 0.0;
    for (size_t k = 0; k < n; ++k) {
      const double weight = primitive->weights[v * n + k];
      if (!(weight > 0.0)) continue;
      const size_t joint = primitive->joints[v * n + k];
      if (joint >= joints.size()) document_.Fail("a vertex names a joint that its skin lacks");
      posed += weight * (joints[joint] * primitive->positions[v]);
      sum += weight;
    }
    if (sum > 0.0) primitive->positions[v] = posed / sum;
  }
}

void GltfReader::AddNode(size_t index) {
  const Json& node = document_.At("nodes", index);
  const std::optional<size_t> mesh_index = IndexMember(node, "mesh");
  if (!mesh_index) return;
  const Json& mesh = document_.At("meshes", *mesh_index);
  const std::optional<size_t> skin = IndexMember(node, "skin");
  std::vector<Eigen::Affine3d> joints;
  if (skin) joints = JointTransforms(*skin);
  std::string name = core::TextMember(mesh, "name");
  if (name.empty()) name = core::TextMember(node, "name");
  const Json* primitives = core::FindMember(mesh, "primitives");
  if (primitives == nullptr || !primitives->is_array()) document_.Fail("a mesh has no primitives");
  for (const Json& source : *primitives) {
    const GltfMaterial material = materials_.Find(IndexMember(source, "material"));
    auto primitive =
        ReadGltfPrimitive(document_, source, material, MorphWeights(node, mesh), skin.has_value());
    if (!primitive) continue;
    const size_t before = raw_.mesh.mesh.triangles.size();
    // Joints place a skinned mesh; its node's transform is ignored.
    const bool posed = skin && primitive->influences > 0;
    if (posed) Pose(joints, &*primitive);
    AddPrimitive(*primitive, material, posed ? Eigen::Affine3d::Identity() : world_[index],
                 static_cast<int>(raw_.mesh.part_names.size()));
    if (raw_.mesh.mesh.triangles.size() > before) {
      raw_.mesh.part_names.push_back(name.empty() ? "part" : name);
    }
  }
}

void GltfReader::AddPrimitive(const GltfPrimitive& primitive, const GltfMaterial& material,
                              const Eigen::Affine3d& placed, int part) {
  core::TexturedMesh& mesh = raw_.mesh;
  if (mesh.mesh.triangles.size() + primitive.triangles.size() / 3 > kMaxMeshFaces) {
    document_.Fail("the mesh has more than 20 million faces", "decimate it first");
  }
  const bool mirrored = placed.linear().determinant() < 0.0;
  const size_t index = static_cast<size_t>(material.index);
  const size_t before = mesh.mesh.triangles.size();
  const bool textured = mesh.materials[index].texture >= 0 || raw_.look.materials[index].HasMaps();
  for (size_t i = 0; i + 2 < primitive.triangles.size(); i += 3) {
    std::uint32_t corners[3] = {primitive.triangles[i], primitive.triangles[i + 1],
                                primitive.triangles[i + 2]};
    if (mirrored) std::swap(corners[1], corners[2]);
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k) {
      // Files store single precision: equal corners of two primitives stay equal.
      const Eigen::Vector3f position = (placed * primitive.positions[corners[k]]).cast<float>();
      t[k] = vertices_.Index(position.cast<double>());
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    mesh.mesh.triangles.push_back(t);
    mesh.triangle_material.push_back(material.index);
    mesh.triangle_part.push_back(part);
    for (const std::uint32_t corner : corners) {
      Eigen::Vector2f uv = primitive.uvs.empty() ? Eigen::Vector2f::Zero() : primitive.uvs[corner];
      if (!uv.allFinite()) uv.setZero();
      mesh.corner_uvs.push_back(uv);
      const bool outside = uv.minCoeff() < -0.01f || uv.maxCoeff() > 1.01f;
      any_outside_ = any_outside_ || (textured && !material.wraps && outside);
      raw_.AddCornerColor(primitive.colors.empty() ? nullptr : &primitive.colors[corner]);
    }
  }
  any_uv_ = any_uv_ || (textured && !primitive.uvs.empty());
  if (primitive.uvs.empty()) {
    raw_.faces_without_uvs[material.index] += mesh.mesh.triangles.size() - before;
  }
}

}  // namespace

RawMesh ReadGltf(const std::filesystem::path& path, FindingList* findings) {
  return GltfReader(path, findings).Read();
}

}  // namespace simwright::assets
