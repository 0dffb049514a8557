#include "texture/uv_atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "core/error.h"
#include "third_party/xatlas/xatlas.h"

namespace simwright::texture {
namespace {

constexpr int kPackings = 12;      // densities that are tried
constexpr double kFilled = 0.97;   // of the side: a packing this large is kept
constexpr double kExpected = 0.6;  // of the texels that a first packing covers

// The mesh in xatlas's form. Its tolerances are absolute, so lengths are scaled: the mean area of a
// triangle is 1.
struct ScaledMesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  double area = 0.0;      // 0: no triangle has an area
  double diagonal = 0.0;  // of the AABB
};

ScaledMesh Scaled(const core::TriangleMesh& mesh) {
  ScaledMesh scaled;
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  const double extent = box.sizes().maxCoeff();
  if (!(extent > 0.0) || !std::isfinite(extent)) return scaled;
  core::TriangleMesh unit = mesh;
  for (Eigen::Vector3d& v : unit.vertices) v = (v - box.center()) / extent;
  const double area = core::SurfaceArea(unit);
  const double factor = std::sqrt(static_cast<double>(mesh.triangles.size()) / area);
  if (!(area > 0.0) || !std::isfinite(factor)) return scaled;
  for (const Eigen::Vector3d& v : unit.vertices) {
    for (int k = 0; k < 3; ++k) scaled.positions.push_back(static_cast<float>(factor * v[k]));
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) scaled.indices.push_back(static_cast<std::uint32_t>(t[k]));
  }
  scaled.area = static_cast<double>(mesh.triangles.size());
  scaled.diagonal = factor * core::Bounds(unit).diagonal().norm();
  return scaled;
}

class Unwrapper {
 public:
  Unwrapper(const core::TriangleMesh& mesh, const AtlasOptions& options)
      : mesh_(mesh), options_(options), scaled_(Scaled(mesh)) {}

  std::vector<Eigen::Vector2f> Unwrap() {
    // Without any area, each triangle takes one texel.
    if (!(scaled_.area > 0.0)) {
      return std::vector<Eigen::Vector2f>(3 * mesh_.triangles.size(), {0.5f, 0.5f});
    }
    MakeCharts();
    Pack();
    CollapseIgnored();
    return std::move(uvs_);
  }

 private:
  void MakeCharts() {
    static const bool silent = (xatlas::SetPrint(nullptr, false), true);
    static_cast<void>(silent);
    xatlas::MeshDecl input;
    input.vertexPositionData = scaled_.positions.data();
    input.vertexCount = static_cast<std::uint32_t>(mesh_.vertices.size());
    input.vertexPositionStride = 3 * sizeof(float);
    input.indexData = scaled_.indices.data();
    input.indexCount = static_cast<std::uint32_t>(scaled_.indices.size());
    input.indexFormat = xatlas::IndexFormat::UInt32;
    if (xatlas::AddMesh(atlas_.get(), input) != xatlas::AddMeshError::Success) {
      throw core::Error("the mesh cannot be cut into charts", "texture atlas");
    }
    xatlas::ChartOptions charts;
    charts.fixWinding = true;
    xatlas::ComputeCharts(atlas_.get(), charts);
  }

  // Packs the charts at one density (texels per unit of length); returns the side of the square
  // that they take, with the margins (texels).
  int PackAt(double density) {
    xatlas::PackOptions packing;
    packing.padding = static_cast<std::uint32_t>(options_.padding);
    packing.texelsPerUnit = static_cast<float>(density);
    packing.bilinear = false;
    packing.rotateCharts = false;  // xatlas turns a chart by a reflection
    // Without the search a chart lands on another where 4096 random places are all taken.
    packing.bruteForce = true;
    packing.blockAlign = true;  // shortens the search
    xatlas::PackCharts(atlas_.get(), packing);
    const std::uint32_t side = std::max(atlas_->width, atlas_->height);
    return static_cast<int>(std::min<std::uint32_t>(side, 1u << 30)) + 2 * options_.padding;
  }

  // Finds the largest density at which the charts fit.
  void Pack() {
    const double usable = std::max(1, options_.size - 2 * options_.padding);
    double density = usable * std::min(std::sqrt(kExpected / scaled_.area), 2.0 / scaled_.diagonal);
    double fits = 0.0, too_large = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < kPackings; ++attempt) {
      const int side = PackAt(density);
      if (side <= options_.size) {
        fits = density;
        TakeUvs(side);
        if (side >= kFilled * options_.size) return;
      } else {
        too_large = density;
      }
      if (too_large < 1.01 * fits) return;
      const double margins = 2.0 * options_.padding;
      density *= 0.995 * usable / std::max(1.0, side - margins);
      if (density >= too_large || density <= fits) density = 0.5 * (fits + too_large);
      if (!std::isfinite(density)) return;
    }
    if (fits > 0.0) return;
    throw core::Error("the mesh has too many separate pieces for a texture of " +
                          std::to_string(options_.size) + " pixels",
                      "", "simplify it or use a larger texture");
  }

  void TakeUvs(int side) {
    const xatlas::Mesh& output = atlas_->meshes[0];
    uvs_.resize(3 * mesh_.triangles.size());
    charted_.resize(mesh_.triangles.size());
    const float padding = static_cast<float>(options_.padding);
    for (std::size_t c = 0; c < uvs_.size(); ++c) {
      const xatlas::Vertex& vertex = output.vertexArray[output.indexArray[c]];
      charted_[c / 3] = vertex.atlasIndex >= 0;
      uvs_[c] = Eigen::Vector2f(vertex.uv[0] + padding, vertex.uv[1] + padding) /
                static_cast<float>(side);
    }
  }

  // Gives the corners of a triangle without area, which belongs to no chart, the coordinates of one
  // of its vertices in another triangle.
  void CollapseIgnored() {
    std::vector<Eigen::Vector2f> at(mesh_.vertices.size(), Eigen::Vector2f(0.5f, 0.5f));
    std::vector<char> known(mesh_.vertices.size(), 0);
    for (std::size_t t = 0; t < charted_.size(); ++t) {
      for (int k = 0; k < 3 && charted_[t]; ++k) {
        at[mesh_.triangles[t][k]] = uvs_[3 * t + k];
        known[mesh_.triangles[t][k]] = 1;
      }
    }
    for (std::size_t t = 0; t < charted_.size(); ++t) {
      if (charted_[t]) continue;
      int vertex = mesh_.triangles[t][0];
      for (int k = 1; k < 3 && !known[vertex]; ++k) vertex = mesh_.triangles[t][k];
      for (int k = 0; k < 3; ++k) uvs_[3 * t + k] = at[vertex];
    }
  }

  const core::TriangleMesh& mesh_;
  const AtlasOptions& options_;
  const ScaledMesh scaled_;
  std::unique_ptr<xatlas::Atlas, void (*)(xatlas::Atlas*)> atlas_{xatlas::Create(),
                                                                  xatlas::Destroy};
  std::vector<Eigen::Vector2f> uvs_;  // (3M x 2)
  std::vector<char> charted_;         // (M)
};

}  // namespace

std::vector<Eigen::Vector2f> UnwrapToAtlas(const core::TriangleMesh& mesh,
                                           const AtlasOptions& options) {
  core::RequireValid(mesh, "texture atlas");
  if (mesh.triangles.empty() || options.size < 16 || options.padding < 0) {
    throw core::Error("an atlas needs a mesh and at least 16 pixels");
  }
  return Unwrapper(mesh, options).Unwrap();
}

}  // namespace simwright::texture
