#include "importers/surface_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "importers/welded_surface.h"

namespace simwright::importers {
namespace {

// The covariance of neighbouring offsets over the noise's variance, for vertices of six neighbours
// of which two are shared: -1/6 - 1/6 + 2/36.
constexpr double kNeighbourCovariance = -0.278;
// Standard deviations between the outermost vertices of both ends of a side, of thousands.
constexpr double kSideSpread = 6.5;
constexpr double kNoticedSide = 0.008;  // of the smallest side

}  // namespace

double SurfaceNoise(const core::TriangleMesh& source) {
  const core::TriangleMesh mesh = WeldedSurface(source).mesh;
  const std::size_t n = mesh.vertices.size();
  std::vector<Eigen::Vector3d> sum(n, Eigen::Vector3d::Zero());
  std::vector<int> count(n, 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      sum[static_cast<std::size_t>(t[k])] += mesh.vertices[t[(k + 1) % 3]];
      ++count[static_cast<std::size_t>(t[k])];
    }
  }
  const std::vector<Eigen::Vector3d> normals = core::VertexNormals(mesh);
  std::vector<double> offset(n, 0.0);
  for (std::size_t v = 0; v < n; ++v) {
    if (count[v] > 0) offset[v] = normals[v].dot(mesh.vertices[v] - sum[v] / count[v]);
  }
  double products = 0.0;
  std::size_t edges = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      products +=
          offset[static_cast<std::size_t>(t[k])] * offset[static_cast<std::size_t>(t[(k + 1) % 3])];
      ++edges;
    }
  }
  if (edges == 0 || products >= 0.0) return 0.0;
  return std::sqrt(products / static_cast<double>(edges) / kNeighbourCovariance);
}

void WarnOfNoise(const std::string& where, const core::TriangleMesh& mesh,
                 core::Findings* findings) {
  const double noise = SurfaceNoise(mesh);
  const double side = core::Bounds(mesh).sizes().minCoeff();
  if (!(side > 0.0) || kSideSpread * noise < kNoticedSide * side) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "its vertices are displaced at random by about %.2g mm: the smallest side may be "
                "%.2g %% too long",
                1000.0 * noise, 100.0 * kSideSpread * noise / side);
  findings->push_back({"mesh-noise", core::Severity::kWarning, where, text, noise,
                       "smooth the mesh in a modeller (Blender: Corrective Smooth), or state the "
                       "true size with --size"});
}

}  // namespace simwright::importers
