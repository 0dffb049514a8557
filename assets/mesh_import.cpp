#include "assets/mesh_import.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>

#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMaxFaces = 20'000'000;
constexpr int kMaxTextureSide = 4096;  // what every GPU and simulator still loads

constexpr const char* kEndings[] = {".obj", ".ply", ".stl", ".glb", ".gltf", ".dae"};

using Warn = std::function<void(const std::string&)>;

// Assimp tries every reader that it has on a file whose own reader does not know it. Only those of
// the formats above stay, so that a broken file meets no other code.
void KeepKnownFormats(Assimp::Importer* importer) {
  for (size_t i = importer->GetImporterCount(); i-- > 0;) {
    std::set<std::string> endings;
    importer->GetImporter(i)->GetExtensionList(endings);
    const bool known = std::any_of(std::begin(kEndings), std::end(kEndings),
                                   [&](const char* e) { return endings.contains(e + 1); });
    if (!known) importer->UnregisterLoader(importer->GetImporter(i));
  }
}

// A file held in memory. Some of Assimp's readers wait for ever for the rest of a file that was cut
// short: reading again and again at the end is an error here.
class HeldFile : public Assimp::IOStream {
 public:
  explicit HeldFile(std::string bytes) : bytes_(std::move(bytes)) {}
  size_t Read(void* buffer, size_t size, size_t count) override {
    if (size == 0 || count == 0) return 0;
    const size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole == 0 && ++reads_at_end_ > kMostReadsAtEnd) {
      throw std::runtime_error("the file ends in the middle of something");
    }
    std::memcpy(buffer, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    const size_t target = base + offset;  // an offset backwards wraps round, as Assimp passes it
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
  std::string bytes_;
  size_t at_ = 0;
  int reads_at_end_ = 0;
};

std::string LowerEnding(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// Whether an OBJ statement is a point, a line, or a face of fewer than three corners.
bool HasNoFace(std::string_view statement) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\\'; };
  int words = 0;
  char keyword = 0;
  for (size_t i = 0; i < statement.size();) {
    while (i < statement.size() && (is_space(statement[i]) || statement[i] == '\n')) ++i;
    const size_t start = i;
    while (i < statement.size() && !is_space(statement[i]) && statement[i] != '\n') ++i;
    if (i == start) break;
    if (words++ > 0) continue;
    if (i - start > 1) return false;
    keyword = statement[start];
  }
  return keyword == 'l' || keyword == 'p' || (keyword == 'f' && words < 4);
}

// Spaces over an OBJ's points and lines: Assimp 5.2 puts them into one mesh with the faces, and its
// own validation then refuses the file.
void BlankLinesAndPoints(std::string* text) {
  for (size_t start = 0; start < text->size();) {
    const auto line_end = [&](size_t from) {
      return std::min(text->find('\n', from), text->size());
    };
    size_t end = line_end(start);
    // A backslash carries a statement on to the next line.
    while (end > start && end < text->size() &&
           ((*text)[end - 1] == '\\' ||
            (end > start + 1 && (*text)[end - 1] == '\r' && (*text)[end - 2] == '\\'))) {
      end = line_end(end + 1);
    }
    if (HasNoFace(std::string_view(*text).substr(start, end - start))) {
      std::fill(text->begin() + static_cast<std::ptrdiff_t>(start),
                text->begin() + static_cast<std::ptrdiff_t>(end), ' ');
    }
    start = end + 1;
  }
}

// Opens files inside one folder alone: a material library or buffer elsewhere is "not there".
class FolderIo : public Assimp::DefaultIOSystem {
 public:
  explicit FolderIo(fs::path root) : root_(std::move(root)) {}
  bool Exists(const char* file) const override {
    return Inside(file) && Assimp::DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!Inside(file) || std::strchr(mode, 'w') != nullptr) return nullptr;
    try {
      std::string bytes = core::ReadFile(file);
      if (LowerEnding(file) == ".obj") BlankLinesAndPoints(&bytes);
      return new HeldFile(std::move(bytes));  // Assimp closes, and so deletes it
    } catch (const core::Error&) {
      return nullptr;
    }
  }

 private:
  bool Inside(const char* file) const {
    try {
      core::ResolveInside(root_, file);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }
  fs::path root_;
};

// Collects Assimp's nodes into one mesh with exactly equal positions shared.
class Collector {
 public:
  Collector(const aiScene& scene, fs::path folder, Warn warn)
      : scene_(scene), folder_(std::move(folder)), warn_(std::move(warn)) {}

  core::TexturedMesh Collect() {
    ReadMaterials();
    AddNode(*scene_.mRootNode, aiMatrix4x4(), 0);
    if (!any_uv_) result_.corner_uvs.clear();
    return std::move(result_);
  }

 private:
  void ReadMaterials();
  int ReadTexture(const aiString& name);
  void AddNode(const aiNode& node, const aiMatrix4x4& parent, int depth);
  void AddMesh(const aiMesh& mesh, const aiMatrix4x4& placed, const std::string& name);
  int VertexIndex(const aiVector3D& position);

  struct Hash {
    size_t operator()(const std::array<double, 3>& p) const {
      size_t h = 0;
      for (const double x : p) h = h * 1000003u ^ std::hash<double>()(x);
      return h;
    }
  };

  const aiScene& scene_;
  fs::path folder_;
  Warn warn_;
  core::TexturedMesh result_;
  std::unordered_map<std::array<double, 3>, int, Hash> vertex_of_;
  std::map<std::string, int> texture_of_;
  bool any_uv_ = false;
};

void Collector::ReadMaterials() {
  for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
    const aiMaterial& source = *scene_.mMaterials[i];
    core::Material material;
    aiString name;
    if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
    if (material.name.empty()) material.name = "material_" + std::to_string(i);
    aiColor4D color;
    if (source.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS ||
        source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) {
      material.base_color = Eigen::Vector4f(color.r, color.g, color.b, color.a)
                                .array()
                                .isFinite()
                                .select(Eigen::Vector4f(color.r, color.g, color.b, color.a), 0.8f);
      material.base_color = material.base_color.cwiseMax(0.0f).cwiseMin(1.0f);
    }
    float opacity = 1.0f;
    if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) {
      material.base_color.w() = std::clamp(opacity, 0.0f, 1.0f);
    }
    aiString file;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &file) == AI_SUCCESS ||
        source.GetTexture(aiTextureType_BASE_COLOR, 0, &file) == AI_SUCCESS) {
      material.texture = ReadTexture(file);
      // OBJ writers often leave Kd black beside a texture: the texture is meant as it is.
      if (material.texture >= 0 && material.base_color.head<3>().maxCoeff() < 0.01f) {
        material.base_color.head<3>().setOnes();
      }
    }
    result_.materials.push_back(material);
  }
}

int Collector::ReadTexture(const aiString& name) {
  const auto [entry, fresh] = texture_of_.try_emplace(name.C_Str(), -1);
  if (!fresh) return entry->second;
  core::ImageReadOptions options;
  options.max_side = kMaxTextureSide;
  try {
    core::Image image;
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.C_Str())) {
      if (embedded->mHeight != 0) throw core::Error("raw embedded pixels are not read");
      image = core::DecodeImage({reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth},
                                name.C_Str(), options);
    } else {
      std::string relative = name.C_Str();
      std::replace(relative.begin(), relative.end(), '\\', '/');
      fs::path path = folder_ / fs::path(relative).filename();
      if (!fs::path(relative).is_absolute()) {
        const fs::path named = core::ResolveInside(folder_, relative);
        if (fs::exists(named)) path = named;
      }
      image = core::ReadImage(path, options);
    }
    entry->second = static_cast<int>(result_.textures.size());
    result_.textures.push_back(std::move(image));
  } catch (const core::Error& error) {
    if (warn_) warn_(std::string("texture left out: ") + error.what());
  }
  return entry->second;
}

int Collector::VertexIndex(const aiVector3D& position) {
  // + 0.0 makes -0.0 and 0.0 one position.
  const std::array<double, 3> key{position.x + 0.0, position.y + 0.0, position.z + 0.0};
  const auto [entry, fresh] =
      vertex_of_.try_emplace(key, static_cast<int>(result_.mesh.vertices.size()));
  if (fresh) result_.mesh.vertices.emplace_back(key[0], key[1], key[2]);
  return entry->second;
}

void Collector::AddMesh(const aiMesh& mesh, const aiMatrix4x4& placed, const std::string& name) {
  if (result_.mesh.triangles.size() + mesh.mNumFaces > kMaxFaces) {
    throw core::Error("the mesh has more than 20 million faces", folder_.string(),
                      "decimate it first");
  }
  const int part = static_cast<int>(result_.part_names.size());
  const aiVector3D* uvs = mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0] : nullptr;
  const bool mirrored = placed.Determinant() < 0.0f;
  const size_t before = result_.mesh.triangles.size();
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    unsigned corners[3] = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrored) std::swap(corners[1], corners[2]);
    if (std::max({corners[0], corners[1], corners[2]}) >= mesh.mNumVertices) continue;
    Eigen::Vector3i t;
    for (int k = 0; k < 3; ++k) t[k] = VertexIndex(placed * mesh.mVertices[corners[k]]);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    result_.mesh.triangles.push_back(t);
    result_.triangle_material.push_back(static_cast<int>(mesh.mMaterialIndex));
    result_.triangle_part.push_back(part);
    for (const unsigned corner : corners) {
      const Eigen::Vector2f uv =
          uvs == nullptr ? Eigen::Vector2f::Zero() : Eigen::Vector2f(uvs[corner].x, uvs[corner].y);
      result_.corner_uvs.push_back(uv.allFinite() ? uv : Eigen::Vector2f::Zero());
    }
  }
  any_uv_ = any_uv_ || uvs != nullptr;
  if (result_.mesh.triangles.size() > before) result_.part_names.push_back(name);
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

}  // namespace

bool HasMeshEnding(const fs::path& path) {
  const std::string ending = LowerEnding(path);
  return std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
}

core::TexturedMesh ReadMesh(const fs::path& path, const Warn& warn) {
  if (!fs::exists(path)) throw core::Error("no such file", path.string());
  if (!fs::is_regular_file(path)) throw core::Error("this is not a file", path.string());
  if (fs::file_size(path) == 0) throw core::Error("the mesh file is empty", path.string());
  if (!HasMeshEnding(path)) {
    throw core::Error("this is not a mesh that can be read", path.string(),
                      "use OBJ, PLY, STL, glTF, GLB or DAE");
  }
  const fs::path folder = fs::absolute(path).parent_path();
  Assimp::Importer importer;
  KeepKnownFormats(&importer);
  importer.SetIOHandler(new FolderIo(folder));  // the importer owns it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(fs::absolute(path).string(), aiProcess_Triangulate |
                                                               aiProcess_SortByPType |
                                                               aiProcess_ValidateDataStructure);
  } catch (const std::exception&) {
    scene = nullptr;
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw core::Error(std::string("the mesh cannot be read: ") + importer.GetErrorString(),
                      path.string(), "export it again, as OBJ or GLB");
  }
  core::TexturedMesh mesh = Collector(*scene, folder, warn).Collect();
  if (mesh.mesh.triangles.empty()) {
    throw core::Error("the mesh has no faces", path.string(), "export its surface, not points");
  }
  core::RequireValid(mesh, path.string());
  return mesh;
}

}  // namespace simwright::assets
