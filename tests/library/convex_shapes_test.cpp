#include "library/convex_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mass_properties.h"
#include "library/articulated/handles.h"

namespace simwright::library {
namespace {

double ConvexShapesVolume(const core::TriangleMesh& mesh) {
  return geometry::SolidMassProperties(mesh, 1.0).volume;
}

// Chamfering an edge of length l by c takes a prism of c^2 / 2 l; at a corner where three meet the
// hull of the three points on the faces remains, which is c^3 / 3 less than the prisms alone say.
TEST(Box, BevelTakesWhatItShould) {
  const double a = 0.3, b = 0.2, c = 0.1, cut = 0.01;
  EXPECT_NEAR(ConvexShapesVolume(Box({0, 0, 0}, {a, b, c}, 0.0)), a * b * c, 1e-12);
  const double edges = 4.0 * 0.5 * cut * cut * ((a - 2 * cut) + (b - 2 * cut) + (c - 2 * cut));
  // The corner cube less the tetrahedron that is left of it at the inner vertex.
  const double corners = 8.0 * (cut * cut * cut - cut * cut * cut / 6.0);
  EXPECT_NEAR(ConvexShapesVolume(Box({a, 0, c}, {0, b, 0}, cut)), a * b * c - edges - corners,
              1e-12);
}

TEST(Frustum, HasThePyramidsVolume) {
  const int n = 20;
  const double low = 0.05, high = 0.02, length = 0.3;
  const double ring = 0.5 * n * std::sin(2.0 * M_PI / n);  // area of an n-gon of radius 1
  const double expected = ring * length / 3.0 * (low * low + low * high + high * high);
  EXPECT_NEAR(ConvexShapesVolume(Frustum({1, 2, 3}, {1, 2 + length, 3}, low, high, n)), expected,
              1e-9 * expected);
}

// Mitred legs share their end faces: the volume is the section times the length of the path.
TEST(Pipe, LegsNeitherOverlapNorGap) {
  const double radius = 0.01;
  const int n = 12;
  std::vector<Eigen::Vector3d> path{{0, 0, 0}, {0, 0, 0.2}, {0.1, 0, 0.3}, {0.3, 0, 0.3}};
  double length = 0.0, volume = 0.0;
  for (size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  for (const core::TriangleMesh& leg : Pipe(path, radius, n)) volume += ConvexShapesVolume(leg);
  const double section = 0.5 * n * std::sin(2.0 * M_PI / n) * radius * radius;
  EXPECT_NEAR(volume, section * length, 1e-9 * volume);
}

TEST(Handles, StandOffTheSurfaceByWhatIsAsked) {
  HandlePlacement place;
  place.mount = {-0.3, 0.1, 0.5};
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitZ();
  for (const HandleKind kind : {HandleKind::kBar, HandleKind::kBow, HandleKind::kKnob}) {
    Eigen::AlignedBox3d box;
    for (const core::TriangleMesh& piece : HandleMeshes(kind, place)) {
      box.extend(core::Bounds(piece));
    }
    EXPECT_NEAR(box.max().x(), -0.3, 1e-6) << HandleName(kind);  // on the surface
    EXPECT_LT(box.min().x(), -0.3 - place.standoff) << HandleName(kind);
    EXPECT_LT(box.sizes().y(), 0.08) << HandleName(kind);  // between the fingers
    EXPECT_NEAR(GripPoint(place).x(), -0.34, 1e-12);
  }
}

}  // namespace
}  // namespace simwright::library
