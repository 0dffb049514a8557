#include "geometry/surface_wrap.h"

#include <gtest/gtest.h>

#include "geometry/mesh_validity.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using shapes::Box;

// Two blocks 0.2 mm apart on a floor, the slit 0.3 deep: a fiftieth of a cell, so that only lines
// of sight can open it.
class HairlineSlit : public ::testing::Test {
 protected:
  HairlineSlit() {
    core::Append(Box({-0.3963, -0.4, 0.1}, {-0.0001, 0.4, 0.4}), &mesh_);
    core::Append(Box({0.0001, -0.4, 0.1}, {0.4, 0.4, 0.4}), &mesh_);
    core::Append(Box({-0.3963, -0.4, 0.0}, {0.4, 0.4, 0.1}), &mesh_);
    options_.cell = 0.01;
    options_.closing = 0.01;
    options_.wall = 0.02;
  }
  TriangleMesh mesh_;
  SurfaceWrapOptions options_;
};

TEST_F(HairlineSlit, StaysClosedWhereNobodyLooksIn) {
  const SurfaceWrap wrap = WrapSurface(mesh_, options_);
  EXPECT_TRUE(Examine(wrap.mesh).IsSolid());
  EXPECT_GT(TriangleTree(wrap.mesh).Closest({0, 0, 0.1}).distance, 0.08);
}

TEST_F(HairlineSlit, ObliqueLinesOfSightOpenIt) {
  // Along the slit, neither along an axis nor through nodes of the grid.
  for (const double slope : {-1.3, -0.41, 0.0, 0.77}) {
    const Vector3d to_eye = Vector3d(0, slope, 1).normalized();
    options_.visible_hits.push_back({{0, 0.1 * slope, 0.1}, to_eye, Vector3d::UnitZ()});
  }
  options_.reach = 0.02;
  const SurfaceWrap wrap = WrapSurface(mesh_, options_);
  const MeshValidity state = Examine(wrap.mesh);
  EXPECT_TRUE(state.IsSolid()) << Describe(state);
  const TriangleTree tree(wrap.mesh);
  for (const OuterHit& hit : options_.visible_hits) {
    EXPECT_LT(tree.Closest(hit.point).distance, options_.reach) << hit.point.transpose();
  }
  // Nothing else has moved.
  for (const double d : DistancesToSurface(wrap.mesh.vertices, mesh_)) EXPECT_LT(d, 0.02);
}

}  // namespace
}  // namespace simwright::geometry
