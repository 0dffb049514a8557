// Solids of closed surfaces that touch or intersect themselves by little: no grid thickens them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "geometry/manifold_split.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "geometry/self_intersection_smoothing.h"
#include "geometry/solid.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

// The boundary of unit cells at the given places.
core::TriangleMesh CellSurface(const std::vector<Eigen::Vector3i>& cells, double side) {
  core::TriangleMesh soup;
  const auto filled = [&](const Eigen::Vector3i& at) {
    return std::find(cells.begin(), cells.end(), at) != cells.end();
  };
  for (const Eigen::Vector3i& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int way : {0, 1}) {
        if (filled(cell + (2 * way - 1) * Eigen::Vector3i::Unit(axis))) continue;
        const Eigen::Vector3i a = Eigen::Vector3i::Unit((axis + 1) % 3);
        const Eigen::Vector3i b = Eigen::Vector3i::Unit((axis + 2) % 3);
        const Eigen::Vector3i base = cell + way * Eigen::Vector3i::Unit(axis);
        const int first = static_cast<int>(soup.vertices.size());
        for (const Eigen::Vector3i& q :
             {base, (base + a).eval(), (base + a + b).eval(), (base + b).eval()}) {
          soup.vertices.push_back(side * q.cast<double>());
        }
        const int second = way == 1 ? 1 : 3, last = way == 1 ? 3 : 1;
        soup.triangles.emplace_back(first, first + second, first + 2);
        soup.triangles.emplace_back(first, first + 2, first + last);
      }
    }
  }
  return Weld(soup, 0.0);
}

TEST(ManifoldSplit, PartsCellsThatTouchAlongAnEdge) {
  const core::TriangleMesh touching = CellSurface({{0, 0, 0}, {1, 1, 0}}, 0.1);
  EXPECT_FALSE(Examine(touching).manifold);
  const core::TriangleMesh parted = SplitNonManifold(touching);
  const MeshValidity state = Examine(parted);
  EXPECT_TRUE(state.closed && state.manifold) << Describe(state);
  EXPECT_EQ(state.components, 2);
  EXPECT_EQ(parted.triangles.size(), touching.triangles.size());
  EXPECT_NEAR(SignedVolume(parted), 0.002, 1e-12);
  // A manifold mesh stays as it is.
  const core::TriangleMesh one = CellSurface({{0, 0, 0}, {1, 0, 0}}, 0.1);
  EXPECT_EQ(SplitNonManifold(one).vertices.size(), one.vertices.size());
}

// A plate of cells one of which is missing at a corner of another: its thickness is kept.
TEST(SolidRepair, AVoxelSurfaceWithATouchingEdgeKeepsItsThickness) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      const bool gone = (x == 20 && y == 20) || (x == 21 && y == 21);
      if (!gone) cells.emplace_back(x, y, 0);
    }
  }
  const core::TriangleMesh plate = CellSurface(cells, 0.005);
  ASSERT_FALSE(Examine(plate).manifold);
  const Solid solid = MakeSolid(plate);
  EXPECT_TRUE(Examine(solid.mesh).IsSolid());
  EXPECT_NE(solid.method, SolidMethod::kWrapped);
  const double volume = static_cast<double>(cells.size()) * std::pow(0.005, 3);
  EXPECT_NEAR(SolidMassProperties(solid.mesh, 1.0).volume / volume, 1.0, 0.005);
  EXPECT_NEAR(core::Bounds(solid.mesh).sizes().z(), 0.005, 1e-5);
}

// A thin plate, finely divided, whose vertices are displaced so that faces fold over.
core::TriangleMesh NoisyPlate(double noise) {
  std::vector<Eigen::Vector3i> cells;
  for (int x = 0; x < 30; ++x) {
    for (int y = 0; y < 30; ++y) cells.emplace_back(x, y, 0);
  }
  core::TriangleMesh plate = CellSurface(cells, 0.005);
  core::Rng rng = core::StreamRng(3, 1);
  for (Eigen::Vector3d& v : plate.vertices) {
    for (int k = 0; k < 3; ++k) v[k] += noise * core::Normal(rng);
  }
  return plate;
}

TEST(SolidRepair, NoiseThatFoldsFacesIsSmoothed) {
  const core::TriangleMesh plate = NoisyPlate(0.0008);
  ASSERT_GT(Examine(plate).self_intersections, 0);
  const double diagonal = core::Bounds(plate).diagonal().norm();
  core::TriangleMesh smoothed = plate;
  SelfIntersectionSmoothing options;
  options.max_move = 0.0015 * diagonal;
  options.replaces_faces = true;
  ASSERT_TRUE(SmoothSelfIntersections(&smoothed, options));
  for (std::size_t v = 0; v < plate.vertices.size(); ++v) {
    EXPECT_LE((smoothed.vertices[v] - plate.vertices[v]).norm(), options.max_move + 1e-12);
  }
  const Solid solid = MakeSolid(plate);
  EXPECT_TRUE(Examine(solid.mesh).IsSolid());
  EXPECT_EQ(solid.method, SolidMethod::kRepaired);
  EXPECT_EQ(solid.findings.at(0).code, "solid-smoothed");
  EXPECT_NEAR(SolidMassProperties(solid.mesh, 1.0).volume / (900 * std::pow(0.005, 3)), 1.0, 0.02);
}

// A finely divided plate of more faces than a solid may have is simplified, not wrapped.
TEST(SolidRepair, ALargeSoundMeshIsSimplified) {
  core::TriangleMesh plate = CellSurface({{0, 0, 0}}, 1.0);
  for (Eigen::Vector3d& v : plate.vertices) v = v.cwiseProduct(Eigen::Vector3d(0.3, 0.2, 0.002));
  for (int i = 0; i < 6; ++i) {  // each pass halves each edge
    core::TriangleMesh fine;
    for (const Eigen::Vector3i& t : plate.triangles) {
      const int first = static_cast<int>(fine.vertices.size());
      for (int k = 0; k < 3; ++k) fine.vertices.push_back(plate.vertices[t[k]]);
      for (int k = 0; k < 3; ++k) {
        fine.vertices.push_back(
            (0.5 * (plate.vertices[t[k]] + plate.vertices[t[(k + 1) % 3]])).eval());
      }
      for (const Eigen::Vector3i& f : {Eigen::Vector3i(0, 3, 5), Eigen::Vector3i(3, 1, 4),
                                       Eigen::Vector3i(5, 4, 2), Eigen::Vector3i(3, 4, 5)}) {
        fine.triangles.push_back(f + Eigen::Vector3i::Constant(first));
      }
    }
    plate = Weld(fine, 0.0);
  }
  SolidOptions options;
  options.face_budget = 4000;
  ASSERT_GT(plate.triangles.size(), 40000u);
  const Solid solid = MakeSolid(plate, options);
  EXPECT_NE(solid.method, SolidMethod::kWrapped);
  EXPECT_LE(solid.mesh.triangles.size(), 40000u);
  EXPECT_NEAR(SolidMassProperties(solid.mesh, 1.0).volume / (0.3 * 0.2 * 0.002), 1.0, 1e-3);
}

}  // namespace
}  // namespace simwright::geometry
