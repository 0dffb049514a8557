#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "assets/pbr_look.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

// The shared types of the mesh readers; private to assets/.

using CornerColor = std::array<std::uint8_t, 4>;  // RGBA, sRGB

constexpr size_t kMaxMeshFaces = 20'000'000;
constexpr int kMaxTextureSide = 4096;  // the size that every GPU and simulator supports

// A mesh under construction, before corner colours become materials or a texture.
struct RawMesh {
  core::TexturedMesh mesh;
  PbrLook look;
  // (3 M) if the file has vertex or face colours, otherwise empty. White for parts without colours.
  std::vector<CornerColor> corner_colors;
  // True if these colours multiply the material's (glTF), false if they replace it (OBJ, PLY, STL,
  // DAE).
  bool colors_multiply = false;
  char up = 0;  // as in MeshFile
  // Material -> the number of its faces for which the file states no texture coordinates.
  std::map<int, std::size_t> faces_without_uvs;

  // Sets the colour of the last added corner; null: white if other corners have a colour. Nothing
  // is stored before the first colour.
  void AddCornerColor(const CornerColor* color);
};

// Collects findings about one file; each code is reported once per location.
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

// Assigns one index to equal positions, as solids require.
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

// Reads an image that a mesh in `folder` names. Returns false, with a finding, if it cannot be
// read.
bool ReadTextureFile(const std::filesystem::path& folder, const std::string& name,
                     FindingList* findings, core::Image* image);

// Returns one channel of an image, the last one if it has fewer; and an image without its alpha.
core::Image ChannelOf(const core::Image& image, int channel);
core::Image WithoutAlpha(const core::Image& image);

// Converts (r, g, b, a) in [0, 1], with rounding.
CornerColor ToCornerColor(const Eigen::Vector4f& color);

}  // namespace simwright::assets
