#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

// What the readers of mesh files share; private to assets/.

using CornerColor = std::array<std::uint8_t, 4>;  // RGBA, sRGB

constexpr size_t kMaxMeshFaces = 20'000'000;
constexpr int kMaxTextureSide = 4096;  // what every GPU and simulator still loads

// A mesh as a reader collects it, before colours at its corners become materials or a texture.
struct RawMesh {
  core::TexturedMesh mesh;
  // (3 M) where the file has colours at vertices or faces, else empty. White where a part has none.
  std::vector<CornerColor> corner_colors;
  // Whether these colours multiply the material's (glTF) or take its place (OBJ, PLY, STL, DAE).
  bool colors_multiply = false;
  char up = 0;  // as in MeshFile

  // The colour of the corner whose coordinates were put in last, or none: white where others have
  // one. Nothing is stored before the first colour.
  void AddCornerColor(const CornerColor* color);
};

// Adds findings about one file; a code is said once for each place in it.
class FindingList {
 public:
  explicit FindingList(std::string file) : file_(std::move(file)) {}
  void Add(core::Severity severity, const std::string& code, const std::string& sentence,
           const std::string& remedy, double figure = 0.0);
  core::Findings Take() { return std::move(findings_); }

 private:
  std::string file_;
  core::Findings findings_;
};

// Gives equal positions one index, as solids need them.
class VertexIndexer {
 public:
  explicit VertexIndexer(core::TriangleMesh* mesh) : mesh_(*mesh) {}
  int Index(const Eigen::Vector3d& position);

 private:
  struct Hash {
    size_t operator()(const std::array<double, 3>& p) const {
      size_t h = 0;
      for (const double x : p) h = h * 1000003u ^ std::hash<double>()(x);
      return h;
    }
  };
  core::TriangleMesh& mesh_;
  std::unordered_map<std::array<double, 3>, int, Hash> index_of_;
};

// Reads a picture that a mesh in `folder` names. False, with a finding, where it cannot be read.
bool ReadTextureFile(const std::filesystem::path& folder, const std::string& name,
                     FindingList* findings, core::Image* image);

// (r, g, b, a) in [0, 1], rounded.
CornerColor ToCornerColor(const Eigen::Vector4f& color);

}  // namespace simwright::assets
