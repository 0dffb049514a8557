#include "geometry/convex_cut.h"

#include <gtest/gtest.h>

#include "geometry/convex_hull.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

core::TriangleMesh UnitCube() {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  return ConvexHull(corners);
}

TEST(CutConvex, LeavesWhatLiesWithin) {
  const core::TriangleMesh slab = CutConvex(UnitCube(), Eigen::Vector3d::UnitZ(), 0.25);
  EXPECT_TRUE(Examine(slab).closed);
  EXPECT_NEAR(SignedVolume(slab), 0.25, 1e-12);
  EXPECT_NEAR(core::Bounds(slab).max().z(), 0.25, 1e-12);
  // Cuts off a corner: a pyramid of three edges of length 0.3.
  const Eigen::Vector3d diagonal = Eigen::Vector3d::Ones().normalized();
  const core::TriangleMesh rest = CutConvex(UnitCube(), -diagonal, -0.3 * diagonal.x());
  EXPECT_NEAR(SignedVolume(rest), 1.0 - 0.3 * 0.3 * 0.3 / 6.0, 1e-12);
}

TEST(CutConvex, KeepsAllOrNothing) {
  EXPECT_NEAR(SignedVolume(CutConvex(UnitCube(), Eigen::Vector3d::UnitX(), 2.0)), 1.0, 1e-12);
  EXPECT_TRUE(CutConvex(UnitCube(), Eigen::Vector3d::UnitX(), -1.0).empty());
  EXPECT_TRUE(CutConvex(UnitCube(), Eigen::Vector3d::UnitX(), 0.0).empty());
}

}  // namespace
}  // namespace simwright::geometry
