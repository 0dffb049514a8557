#include "assets/assimp_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>

#include "assets/dae_metadata.h"
#include "assets/mesh_format.h"
#include "assets/obj_materials.h"
#include "assets/obj_text.h"
#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxAssimpBytes = 4ull << 30;

// Removes all readers but those of the supported formats. Assimp tries each of its readers on a
// file that the format's own reader rejects, and a broken file must not reach other code.
void KeepKnownFormats(Assimp::Importer* importer) {
  static const std::set<std::string> kKept{"obj", "stl", "dae"};
  for (size_t i = importer->GetImporterCount(); i-- > 0;) {
    std::set<std::string> endings;
    importer->GetImporter(i)->GetExtensionList(endings);
    const bool known = std::any_of(endings.begin(), endings.end(),
                                   [](const auto& ending) { return kKept.contains(ending); });
    if (!known) importer->UnregisterLoader(importer->GetImporter(i));
  }
}

// A file in memory. Some of Assimp's readers loop forever at the end of a truncated file: repeated
// reads at the end are an error here.
class MemoryFile : public Assimp::IOStream {
 public:
  explicit MemoryFile(const std::string& bytes) : bytes_(bytes) {}
  size_t Read(void* buffer, size_t size, size_t count) override {
    if (size == 0 || count == 0) return 0;
    const size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole == 0 && ++reads_at_end_ > kMostReadsAtEnd) {
      throw std::runtime_error("the file ends prematurely");
    }
    std::memcpy(buffer, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const size_t target = base + offset;  // a negative offset wraps around, as Assimp passes it
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return bytes_.size(); }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  void Flush() override {}

 private:
  static constexpr int kMostReadsAtEnd = 1000;
  const std::string& bytes_;
  size_t at_ = 0;
  int reads_at_end_ = 0;
};

// Gives Assimp the files set here and nothing on the disk.
class MemoryFiles : public Assimp::DefaultIOSystem {
 public:
  explicit MemoryFiles(std::map<std::string, std::string> files) : files_(std::move(files)) {}
  bool Exists(const char* file) const override {
    return files_.contains(fs::path(file).filename().string());
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::strchr(mode, 'w') != nullptr) return nullptr;
    const auto found = files_.find(fs::path(file).filename().string());
    // Assimp closes and deletes it.
    return found == files_.end() ? nullptr : new MemoryFile(found->second);
  }

 private:
  std::map<std::string, std::string> files_;  // by file name
};

// The properties of an OBJ's text that Assimp does not import.
struct ObjProperties {
  std::vector<MtlMaterial> materials;
  bool colors_in_bytes = false;
};

// Merges Assimp's nodes into one mesh with exactly equal positions shared.
class Collector {
 public:
  Collector(const aiScene& scene, fs::path folder, const ObjProperties* obj, FindingList* findings)
      : scene_(scene),
        folder_(std::move(folder)),
        obj_(obj),
        findings_(*findings),
        vertices_(&raw_.mesh.mesh) {}

  RawMesh Collect() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) ReadMaterial(*scene_.mMaterials[i], i);
    AddNode(*scene_.mRootNode, aiMatrix4x4(), 0);
    if (!any_uv_) raw_.mesh.corner_uvs.clear();
    if (!states_look_) raw_.look = {};
    if (any_outside_) {
      findings_.Add(core::Severity::kInfo, "texture-wraps",
                    "a texture that its file clamps at its edges is repeated instead",
                    "keep its coordinates within [0, 1]");
    }
    return std::move(raw_);
  }

 private:
  // The mapping from the mesh's coordinates to those of a material's texture.
  struct UvSource {
    unsigned channel = 0;
    Eigen::Vector2f scale{1.0f, 1.0f}, offset{0.0f, 0.0f};
    bool clamp = false;
  };

  void ReadMaterial(const aiMaterial& source, unsigned index);
  bool ReadObjMaterial(const std::string& name, core::Material* material, PbrMaterial* look,
                       UvSource* uv);
  void ReadObjLook(const MtlMaterial& source, PbrMaterial* look);
  int ReadMap(const MtlMap& map, bool grey);
  void ReadOwnMaterial(const aiMaterial& source, core::Material* material, UvSource* uv);
  int ReadTexture(const std::string& name);
  void AddNode(const aiNode& node, const aiMatrix4x4& parent, int depth);
  void AddMesh(const aiMesh& mesh, const aiMatrix4x4& placed, const std::string& name);
  void AddCorner(const aiMesh& mesh, unsigned corner, const UvSource& uv);

  const aiScene& scene_;
  fs::path folder_;
  const ObjProperties* obj_;
  FindingList& findings_;
  RawMesh raw_;
  VertexIndexer vertices_;
  std::vector<UvSource> uv_of_;  // per material
  std::map<std::string, int> texture_of_;
  std::map<std::pair<std::string, int>, int> map_of_;  // (file, channel or -1) -> map or -1
  bool any_uv_ = false, any_outside_ = false, states_look_ = false;
};

int Collector::ReadMap(const MtlMap& map, bool grey) {
  if (map.file.empty()) return -1;
  const auto [entry, fresh] = map_of_.try_emplace({map.file, grey ? map.channel : -1}, -1);
  core::Image image;
  if (fresh && ReadTextureFile(folder_, map.file, &findings_, &image)) {
    entry->second = static_cast<int>(raw_.look.images.size());
    raw_.look.images.push_back(grey ? ChannelOf(image, map.channel) : WithoutAlpha(image));
  }
  return entry->second;
}

// Reads Pm, Pr, map_Pm, map_Pr and norm. A factor beside a map is 1 where it is left out or 0:
// exporters state 0 for an input that the map replaces.
void Collector::ReadObjLook(const MtlMaterial& source, PbrMaterial* look) {
  look->metallic_map = ReadMap(source.metallic_map, true);
  look->roughness_map = ReadMap(source.roughness_map, true);
  look->normal_map = ReadMap(source.normal_map, false);
  look->normal_scale = source.normal_map.strength;
  const auto factor = [](const std::optional<float>& stated, int map, float otherwise) {
    if (map < 0) return stated.value_or(otherwise);
    return stated.value_or(0.0f) > 0.0f ? *stated : 1.0f;
  };
  look->metallic = factor(source.metallic, look->metallic_map, 0.0f);
  look->roughness = factor(source.roughness, look->roughness_map, 1.0f);
  states_look_ = states_look_ || source.metallic || source.roughness || look->HasMaps();
}

bool Collector::ReadObjMaterial(const std::string& name, core::Material* material,
                                PbrMaterial* look, UvSource* uv) {
  if (obj_ == nullptr || name.size() < 2 || name[0] != 'm') return false;
  const size_t index = static_cast<size_t>(std::atoll(name.c_str() + 1));
  if (index >= obj_->materials.size() || name != "m" + std::to_string(index)) return false;
  const MtlMaterial& source = obj_->materials[index];
  material->name = source.name;
  material->base_color.head<3>() = source.diffuse;
  material->base_color.w() = source.opacity;
  uv->scale = source.uv_scale;
  uv->offset = source.uv_offset;
  uv->clamp = source.clamp;
  ReadObjLook(source, look);
  if (!source.texture.empty()) {
    material->texture = ReadTexture(source.texture);
    if (material->texture >= 0 && !source.has_diffuse) material->base_color.head<3>().setOnes();
  }
  return true;
}

void Collector::ReadOwnMaterial(const aiMaterial& source, core::Material* material, UvSource* uv) {
  aiColor4D color;
  if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) {
    const Eigen::Vector4f read(color.r, color.g, color.b, color.a);
    material->base_color = read.array().isFinite().select(read, 0.8f).cwiseMax(0.0f).cwiseMin(1.0f);
  }
  float opacity = 1.0f;
  if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && std::isfinite(opacity)) {
    material->base_color.w() = std::clamp(opacity, 0.0f, 1.0f);
  }
  aiString file;
  if (source.GetTexture(aiTextureType_DIFFUSE, 0, &file) != AI_SUCCESS) return;
  material->texture = ReadTexture(file.C_Str());
  int channel = 0;
  if (source.Get(AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0), channel) == AI_SUCCESS &&
      channel >= 0 && channel < AI_MAX_NUMBER_OF_TEXTURECOORDS) {
    uv->channel = static_cast<unsigned>(channel);
  }
}

void Collector::ReadMaterial(const aiMaterial& source, unsigned index) {
  core::Material material;
  PbrMaterial look;
  UvSource uv;
  aiString name;
  if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
  if (!ReadObjMaterial(material.name, &material, &look, &uv)) {
    if (obj_ == nullptr) ReadOwnMaterial(source, &material, &uv);
  }
  if (material.name.empty()) material.name = "material_" + std::to_string(index);
  // Writers often leave the colour black beside a texture; the texture is then used unmodulated.
  if (material.texture >= 0 && material.base_color.head<3>().maxCoeff() < 0.01f) {
    material.base_color.head<3>().setOnes();
  }
  raw_.mesh.materials.push_back(material);
  raw_.look.materials.push_back(look);
  uv_of_.push_back(uv);
}

int Collector::ReadTexture(const std::string& name) {
  const auto [entry, fresh] = texture_of_.try_emplace(name, -1);
  core::Image image;
  if (fresh && ReadTextureFile(folder_, name, &findings_, &image)) {
    entry->second = static_cast<int>(raw_.mesh.textures.size());
    raw_.mesh.textures.push_back(std::move(image));
  }
  return entry->second;
}

void Collector::AddCorner(const aiMesh& mesh, unsigned corner, const UvSource& uv) {
  Eigen::Vector2f at = Eigen::Vector2f::Zero();
  if (mesh.HasTextureCoords(uv.channel)) {
    const aiVector3D& read = mesh.mTextureCoords[uv.channel][corner];
    at = Eigen::Vector2f(read.x, read.y).cwiseProduct(uv.scale) + uv.offset;
    if (!at.allFinite()) at.setZero();
    const bool outside = at.minCoeff() < -0.01f || at.maxCoeff() > 1.01f;
    any_outside_ = any_outside_ || (uv.clamp && outside);
  }
  raw_.mesh.corner_uvs.push_back(at);
  if (!mesh.HasVertexColors(0)) {
    raw_.AddCornerColor(nullptr);
    return;
  }
  const aiColor4D& read = mesh.mColors[0][corner];
  Eigen::Vector4f color(read.r, read.g, read.b, read.a);
  if (obj_ != nullptr && obj_->colors_in_bytes) color.head<3>() /= 255.0f;
  const CornerColor rounded = ToCornerColor(color);
  raw_.AddCornerColor(&rounded);
}

void Collector::AddMesh(const aiMesh& mesh, const aiMatrix4x4& placed, const std::string& name) {
  core::TexturedMesh& result = raw_.mesh;
  if (result.mesh.triangles.size() + mesh.mNumFaces > kMaxMeshFaces) {
    throw core::Error("the mesh has more than 20 million faces", folder_.string(),
                      "decimate it first");
  }
  const int part = static_cast<int>(result.part_names.size());
  const bool mirrored = placed.Determinant() < 0.0f;
  const size_t before = result.mesh.triangles.size();
  const UvSource& uv = uv_of_[mesh.mMaterialIndex];
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    unsigned corners[3] = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrored) std::swap(corners[1], corners[2]);
    if (std::max({corners[0], corners[1], corners[2]}) >= mesh.mNumVertices) continue;
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k) {
      const aiVector3D position = placed * mesh.mVertices[corners[k]];
      t[k] = vertices_.Index({position.x, position.y, position.z});
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    result.mesh.triangles.push_back(t);
    result.triangle_material.push_back(static_cast<int>(mesh.mMaterialIndex));
    result.triangle_part.push_back(part);
    for (const unsigned corner : corners) AddCorner(mesh, corner, uv);
  }
  any_uv_ = any_uv_ || mesh.HasTextureCoords(uv.channel);
  if (!mesh.HasTextureCoords(uv.channel)) {
    raw_.faces_without_uvs[static_cast<int>(mesh.mMaterialIndex)] +=
        result.mesh.triangles.size() - before;
  }
  if (result.mesh.triangles.size() > before) result.part_names.push_back(name);
}

void Collector::AddNode(const aiNode& node, const aiMatrix4x4& parent, int depth) {
  if (depth > 500) throw core::Error("the scene graph is nested too deeply", folder_.string());
  const aiMatrix4x4 placed = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
    std::string name = mesh.mName.length > 0 ? mesh.mName.C_Str() : node.mName.C_Str();
    AddMesh(mesh, placed, name.empty() ? "part" : name);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) AddNode(*node.mChildren[i], placed, depth + 1);
}

// The file as input for Assimp, with the properties of an OBJ or a DAE that Assimp does not import.
class Source {
 public:
  Source(const fs::path& path, FindingList* findings) : path_(path) {
    std::string bytes = core::ReadFile(path, kMaxAssimpBytes);
    const MeshFormat format = MeshFormatOf(path);
    if (format == MeshFormat::kObj) {
      PrepareMaterials(PrepareObj(bytes), findings);
      return;
    }
    if (format == MeshFormat::kDae) ReadHead(bytes, findings);
    files_[path.filename().string()] = std::move(bytes);
  }

  const ObjProperties* obj() const { return is_obj_ ? &obj_ : nullptr; }
  char up() const { return up_; }
  std::map<std::string, std::string> TakeFiles() { return std::move(files_); }

 private:
  void PrepareMaterials(PreparedObj text, FindingList* findings) {
    is_obj_ = true;
    obj_.materials = ReadObjMaterials(path_, text, findings);
    obj_.colors_in_bytes = text.colors_in_bytes;
    if (text.has_surfaces) {
      findings->Add(core::Severity::kWarning, "obj-surfaces",
                    "free-form curves and surfaces are ignored: only polygons are read",
                    "convert them to a mesh and export again");
    }
    files_["materials.mtl"] = NumberedLibrary(obj_.materials);
    files_[path_.filename().string()] = std::move(text.text);
  }

  void ReadHead(const std::string& bytes, FindingList* findings) {
    const DaeMetadata head = ReadDaeMetadata(bytes);
    up_ = head.up;
    if (head.unread.empty()) return;
    findings->Add(core::Severity::kInfo, "dae-not-read", "not read: " + head.unread,
                  "apply modifiers and poses before the export where they matter");
  }

  fs::path path_;
  bool is_obj_ = false;
  ObjProperties obj_;
  char up_ = 0;
  std::map<std::string, std::string> files_;
};

}  // namespace

RawMesh ReadWithAssimp(const fs::path& path, FindingList* findings) {
  Source source(path, findings);
  Assimp::Importer importer;
  KeepKnownFormats(&importer);
  importer.SetIOHandler(new MemoryFiles(source.TakeFiles()));  // the importer owns it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // Otherwise Assimp rotates a DAE to y up silently.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                                 aiProcess_ValidateDataStructure);
  } catch (const std::exception&) {
    scene = nullptr;
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw core::Error(std::string("the mesh cannot be read: ") + importer.GetErrorString(),
                      path.string(), "it is damaged or cut short: export it again, as OBJ or GLB");
  }
  RawMesh raw = Collector(*scene, path.parent_path(), source.obj(), findings).Collect();
  raw.up = source.up();
  return raw;
}

}  // namespace simwright::assets
