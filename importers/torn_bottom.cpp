#include "importers/torn_bottom.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/hole_filling.h"
#include "importers/face_selection.h"
#include "importers/welded_surface.h"

namespace simwright::importers {
namespace {

constexpr int kManyHoles = 12;      // in the bottom, which is then torn
constexpr double kBand = 0.012;     // share of the diagonal, above the lowest point
constexpr double kLevel = 0.35;     // least |z| of the unit normal of a bottom's face
constexpr double kMostFaces = 0.3;  // of the mesh, in a torn bottom

}  // namespace

void RemoveTornBottom(const std::string& where, core::TexturedMesh* mesh,
                      core::Findings* findings) {
  const geometry::WeldedMesh welded = WeldedSurface(mesh->mesh);
  const std::vector<Eigen::Vector3d>& vertices = welded.mesh.vertices;
  const Eigen::AlignedBox3d box = core::Bounds(welded.mesh);
  const double band = box.min().z() + kBand * box.diagonal().norm();
  double top = -std::numeric_limits<double>::infinity();
  int holes = 0;
  for (const geometry::BoundaryLoop& loop : geometry::BoundaryLoops(welded.mesh)) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const int v : loop) highest = std::max(highest, vertices[static_cast<std::size_t>(v)].z());
    if (highest > band) continue;
    top = std::max(top, highest);
    ++holes;
  }
  if (holes < kManyHoles) return;
  std::vector<char> kept(mesh->mesh.triangles.size(), 1);
  for (std::size_t f = 0; f < kept.size(); ++f) {
    const int w = welded.face_of[f];
    if (w < 0) continue;
    const Eigen::Vector3i& t = welded.mesh.triangles[static_cast<std::size_t>(w)];
    bool low = true;
    for (int k = 0; k < 3; ++k) low = low && vertices[static_cast<std::size_t>(t[k])].z() <= top;
    const Eigen::Vector3d normal = core::TriangleAreaVector(welded.mesh, w).normalized();
    kept[f] = !(low && !(std::abs(normal.z()) < kLevel));
  }
  const auto gone = std::count(kept.begin(), kept.end(), 0);
  if (gone == 0 || static_cast<double>(gone) > kMostFaces * static_cast<double>(kept.size())) {
    return;
  }
  KeepFaces(kept, mesh);
  findings->push_back(
      {"mesh-torn-bottom", core::Severity::kWarning, where,
       "the bottom is torn into " + std::to_string(holes) + " holes: it is replaced by a flat one",
       static_cast<double>(holes),
       "look at preview.png; close the bottom in a modeller if it is not flat"});
}

}  // namespace simwright::importers
