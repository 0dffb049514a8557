#include "geometry/simplify.h"
#include "geometry/cluster_vertices.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/alpha_wrap.h"
#include "geometry/edge_collapse.h"
#include "geometry/isosurface.h"
#include "geometry/mesh_validity.h"
#include "geometry/remesh.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

// |p| = 0.7 or a thin plate at z = 0.85, as an isosurface.
TriangleMesh SphereUnderPlate(int n) {
  ScalarGrid grid;
  grid.nx = grid.ny = grid.nz = n;
  grid.cell = 2.0 / (n - 1);
  grid.origin.setConstant(-1.0);
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Vector3d p = grid.origin + grid.cell * Vector3d(i, j, k);
        const double plate = (p - Vector3d(0, 0, 0.8))
                                 .cwiseAbs()
                                 .cwiseQuotient(Vector3d(0.9, 0.9, 0.04))
                                 .maxCoeff() -
                             1.0;
        grid.values.push_back(static_cast<float>(std::min(p.norm() - 0.7, 0.04 * plate)));
      }
    }
  }
  return ExtractIsosurface(grid, 0.0f);
}

TEST(Simplify, KeepsItSoundAndInPlace) {
  const TriangleMesh fine = SphereUnderPlate(81);
  const MeshValidity before = Examine(fine);
  ASSERT_TRUE(before.IsSolid()) << Describe(before);
  const TriangleMesh coarse = Simplify(fine, {800, 0.0});
  const MeshValidity after = Examine(coarse);
  EXPECT_TRUE(after.IsSolid()) << Describe(after);
  EXPECT_LE(coarse.triangles.size(), 800u);
  EXPECT_EQ(after.components, before.components);
  EXPECT_NEAR(after.signed_volume, before.signed_volume, 0.01 * before.signed_volume);
  EXPECT_LT(OuterSurfaceDistance(fine, coarse).MaxRatio(), 0.01);
}

TEST(Simplify, TheErrorLimitHoldsBeforeTheBudget) {
  const TriangleMesh fine = SphereUnderPlate(61);
  const TriangleMesh close = Simplify(fine, {4, 1e-4});
  const TriangleMesh rough = Simplify(fine, {4, 1e-2});
  EXPECT_GT(close.triangles.size(), 3 * rough.triangles.size());
  EXPECT_LT(OuterSurfaceDistance(fine, close).visual_to_solid_p99, 5e-4);
}

// A box with a trench 2.4 cells wide and 0.5 deep: its area is small, so the mean error ignores it.
TriangleMesh TrenchedBox() {
  ScalarGrid grid;
  grid.nx = grid.ny = grid.nz = 81;
  grid.cell = 2.0 / 80;
  grid.origin.setConstant(-1.0);
  const auto box = [](const Vector3d& p, const Vector3d& center, const Vector3d& half) {
    return ((p - center).cwiseAbs() - half).maxCoeff();
  };
  for (int n = 0; n < 81 * 81 * 81; ++n) {
    const Vector3d p = grid.origin + grid.cell * Vector3d(n % 81, n / 81 % 81, n / (81 * 81));
    const double solid = box(p, Vector3d::Zero(), Vector3d::Constant(0.8));
    const double trench = box(p, {0.011, 0, 0.8}, {0.03, 0.3, 0.5});
    grid.values.push_back(static_cast<float>(std::max(solid, -trench)));
  }
  return ExtractIsosurface(grid, 0.0f);
}

TEST(Simplify, TheDistanceLimitKeepsWhatTheMeanHides) {
  const TriangleMesh fine = TrenchedBox();
  const auto farthest = [](const TriangleMesh& from, const TriangleMesh& to) {
    double most = 0.0;
    for (const double d : DistancesToSurface(from.vertices, to)) most = std::max(most, d);
    return most;
  };
  const SimplifyOptions mean{4, 0.03, 0.0};
  EXPECT_GT(farthest(fine, Simplify(fine, mean)), 0.12);
  const SimplifyOptions both{4, 0.03, 0.05};
  const TriangleMesh kept = Simplify(fine, both);
  EXPECT_TRUE(Examine(kept).IsSolid());
  EXPECT_LT(kept.triangles.size(), fine.triangles.size() / 3);
  // At most three passes, each within the limit.
  EXPECT_LT(farthest(fine, kept), 3 * 0.05);
  EXPECT_LT(farthest(kept, fine), 3 * 0.05);
}

TEST(Simplify, RefusesWhatIsNotClosed) {
  TriangleMesh open = SphereUnderPlate(21);
  open.triangles.pop_back();
  EXPECT_THROW(Simplify(open, {100, 0.0}), core::Error);
  EXPECT_THROW(Simplify({}, {100, 0.0}), core::Error);
  EXPECT_THROW(CollapseEdges(SphereUnderPlate(21), {}, 4, 0.0), core::Error);
}

TEST(ClusterVertices, MovesNothingFartherThanItsCell) {
  const TriangleMesh fine = SphereUnderPlate(61);
  const double cell = 0.1;
  const TriangleMesh thin = ClusterVertices(fine, cell);
  EXPECT_LT(thin.triangles.size(), fine.triangles.size() / 4);
  for (const double d : DistancesToSurface(thin.vertices, fine)) EXPECT_EQ(d, 0.0);
  for (const double d : DistancesToSurface(fine.vertices, thin)) {
    EXPECT_LE(d, cell * std::sqrt(3.0));
  }
  EXPECT_THROW(ClusterVertices(fine, 0.0), core::Error);
}

TEST(AlphaWrap, LiesItsOffsetOutside) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleMesh wrap = AlphaWrap(sheet, {1.0 / 20.0, 1.0 / 100.0});
  const MeshValidity state = Examine(wrap);
  EXPECT_TRUE(state.IsSolid()) << Describe(state);
  const double offset = std::sqrt(2.0) / 100.0;
  for (const double d : DistancesToSurface(wrap.vertices, sheet))
    EXPECT_NEAR(d, offset, 0.3 * offset);
  EXPECT_THROW(AlphaWrap({}), core::Error);
}

TEST(Remesh, EdgesComeNearTheTarget) {
  TriangleMesh box;
  for (int c = 0; c < 8; ++c) box.vertices.emplace_back(c & 1, (c >> 1) & 1, (c >> 2) & 1);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  RemeshOptions options;
  options.edge_length = 0.1;
  const TriangleMesh even = RemeshIsotropic(box, options);
  EXPECT_TRUE(Examine(even).IsSolid());
  EXPECT_NEAR(SignedVolume(even), 1.0, 1e-9);
  double sum = 0.0;
  for (const auto& t : even.triangles) {
    for (int c = 0; c < 3; ++c) {
      sum += (even.vertices[t[c]] - even.vertices[t[(c + 1) % 3]]).norm();
    }
  }
  EXPECT_NEAR(sum / (3.0 * even.triangles.size()), 0.1, 0.025);
  options.edge_length = 0.0;
  EXPECT_THROW(RemeshIsotropic(box, options), core::Error);
}

TEST(Weld, JoinsDropsAndOrients) {
  TriangleMesh soup;
  // A tetrahedron's faces with separate corners, one face repeated, one flipped.
  const Vector3d p[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Eigen::Vector3i& t :
       {Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(0, 3, 1), Eigen::Vector3i(0, 3, 2),
        Eigen::Vector3i(1, 2, 3), Eigen::Vector3i(3, 1, 2)}) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int c = 0; c < 3; ++c) soup.vertices.push_back(p[t[c]]);
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  TriangleMesh welded = Weld(soup, 0.0);
  EXPECT_EQ(welded.vertices.size(), 4u);
  EXPECT_EQ(welded.triangles.size(), 4u);
  EXPECT_TRUE(OrientConsistently(&welded));
  EXPECT_NEAR(SignedVolume(welded), 1.0 / 6.0, 1e-15);
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) soup.vertices[v].x() += 1e-7 * v;
  EXPECT_EQ(Weld(soup, 0.0).vertices.size(), 15u);
  EXPECT_EQ(Weld(soup, 1e-5).vertices.size(), 4u);
  int count = 0;
  EdgeComponents(soup, &count);
  EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace simwright::geometry
