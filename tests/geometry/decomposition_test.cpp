#include "geometry/convex_decomposition.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/concavity.h"
#include "geometry/convex_hull.h"
#include "geometry/distance.h"
#include "geometry/mesh_validity.h"
#include "geometry/plane_clip.h"
#include "geometry/simplify.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"
#include "tests/sanitized.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using shapes::BoxAt;
using shapes::BoxUnion;

// Expects a closed hull, oriented outward, of at most 64 vertices, with no vertex above any face.
void ExpectConvexParts(const ConvexDecomposition& decomposition) {
  ASSERT_FALSE(decomposition.parts.empty());
  for (const ConvexPart& part : decomposition.parts) {
    const MeshValidity s = Examine(part.hull);
    EXPECT_TRUE(s.closed && s.oriented && s.manifold) << Describe(s);
    EXPECT_EQ(s.degenerate_triangles, 0);
    EXPECT_GT(s.signed_volume, 0.0);
    EXPECT_LE(part.hull.vertices.size(), 64u);
    const double size = core::Bounds(part.hull).diagonal().norm();
    for (int t = 0; t < static_cast<int>(part.hull.triangles.size()); ++t) {
      const Vector3d area = core::TriangleAreaVector(part.hull, t);
      const Vector3d& on = part.hull.vertices[part.hull.triangles[t][0]];
      for (const Vector3d& v : part.hull.vertices) {
        EXPECT_LT(area.normalized().dot(v - on), 2e-3 * size);
      }
    }
  }
}

TEST(SplitByPlane, VolumesAddUpAndPiecesAreClosed) {
  core::Rng rng(4);
  const core::TriangleMesh solids[] = {
      shapes::Torus(1.0, 0.3, 40, 16), shapes::Cup(.5, 1, .1, 40),
      BoxUnion({BoxAt(0, 0, 0, 3, 1, 1), BoxAt(0, 0, 0, 1, 1, 3), BoxAt(2, 0, 0, 3, 1, 3)})};
  for (const core::TriangleMesh& solid : solids) {
    for (int i = 0; i < 60; ++i) {
      const Vector3d normal = core::UniformDirection(rng);
      const Vector3d through = core::Bounds(solid).sample();
      const auto pieces = SplitByPlane(solid, {normal, normal.dot(through)}, 1e-9);
      if (pieces.empty()) continue;
      double sum = 0.0;
      for (const core::TriangleMesh& piece : pieces) {
        const MeshValidity s = Examine(piece, 1);
        EXPECT_TRUE(s.closed) << Describe(s);
        sum += s.signed_volume;
      }
      EXPECT_NEAR(sum / SignedVolume(solid), 1.0, 1e-6);
    }
  }
}

TEST(SplitByPlane, ThroughVerticesAndFacesAndAcrossHoles) {
  // At the height of the U's notch the plane contains faces; two legs and a base remain.
  const core::TriangleMesh u =
      BoxUnion({BoxAt(0, 0, 0, 3, 1, 1), BoxAt(0, 0, 0, 1, 1, 3), BoxAt(2, 0, 0, 3, 1, 3)});
  const auto pieces = SplitByPlane(u, {Vector3d::UnitZ(), 1.0}, 1e-9);
  ASSERT_EQ(pieces.size(), 3u);
  for (const core::TriangleMesh& piece : pieces) {
    EXPECT_TRUE(Examine(piece).closed);
    EXPECT_NEAR(SignedVolume(piece), SignedVolume(ConvexHull(piece.vertices)), 1e-9);
  }
  // Across the ring: caps are rings, too. Along it: two C shapes, with two discs each.
  EXPECT_EQ(SplitByPlane(shapes::Torus(1, .3, 32, 16), {Vector3d::UnitZ(), 0.05}, 1e-9).size(), 2u);
  EXPECT_EQ(SplitByPlane(shapes::Torus(1, .3, 32, 16), {Vector3d::UnitX(), 0.0}, 1e-9).size(), 2u);
  EXPECT_TRUE(SplitByPlane(u, {Vector3d::UnitZ(), 3.0}, 1e-9).empty());
  EXPECT_TRUE(SplitByPlane(u, {Vector3d::UnitZ(), 5.0}, 1e-9).empty());
}

TEST(SplitByPlane, VoidStaysWithItsBody) {
  core::TriangleMesh hollow = shapes::Box(3, 3, 3), inner = shapes::Box(1, 1, 1);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(1, 1, 1)), &inner);
  for (auto& t : inner.triangles) std::swap(t[0], t[1]);
  core::Append(inner, &hollow);
  const auto pieces = SplitByPlane(hollow, {Vector3d::UnitX(), 0.5}, 1e-9);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(SignedVolume(pieces[0]) + SignedVolume(pieces[1]), 26.0, 1e-9);
}

TEST(Decompose, ConvexSolidStaysWhole) {
  const ConvexDecomposition box = Decompose(shapes::Box(1, 2, 3));
  ASSERT_EQ(box.parts.size(), 1u);
  EXPECT_NEAR(SignedVolume(box.parts[0].hull), 6.0, 1e-9);
  EXPECT_LT(box.concavity, 1e-9);
  EXPECT_EQ(Decompose(shapes::Sphere(1, 48)).parts.size(), 1u);
}

TEST(Decompose, BoxesAreFoundExactly) {
  const core::TriangleMesh l = BoxUnion({BoxAt(0, 0, 0, 3, 1, 1), BoxAt(0, 0, 0, 1, 1, 3)});
  const core::TriangleMesh table =
      BoxUnion({BoxAt(0, 0, 2, 4, 3, 2.2), BoxAt(0, 0, 0, .2, .2, 2), BoxAt(3.8, 0, 0, 4, .2, 2),
                BoxAt(0, 2.8, 0, .2, 3, 2), BoxAt(3.8, 2.8, 0, 4, 3, 2)});
  for (const auto& [mesh, count] : {std::pair{l, 2u}, std::pair{table, 5u}}) {
    const ConvexDecomposition d = Decompose(mesh);
    ExpectConvexParts(d);
    EXPECT_EQ(d.parts.size(), count);
    const DecompositionQuality q = MeasureDecomposition(mesh, Hulls(d));
    EXPECT_LT(q.concavity, 1e-6);
    EXPECT_LT(q.volume_error, 1e-6);
    EXPECT_EQ(q.coverage, 1.0);
  }
}

TEST(Decompose, MeetsTheThresholdCoversAndLeavesHollowsOpen) {
  SKIP_UNDER_SANITIZERS();
  for (const core::TriangleMesh& mesh :
       {shapes::Torus(1, .3, 32, 16), shapes::Cup(.04, .1, .004, 24), shapes::Bowl(.08, .01, 24)}) {
    const ConvexDecomposition d = Decompose(mesh);
    ExpectConvexParts(d);
    EXPECT_LE(d.concavity, 0.05 + 1e-3);
    const DecompositionQuality q = MeasureDecomposition(mesh, Hulls(d));
    // Half the longest side counts 1 in the threshold, and a diagonal is at least twice that.
    EXPECT_LT(q.parts_to_solid, 0.05 / 2.0);
    EXPECT_LT(q.missing_volume, 0.03);
    EXPECT_GT(d.coverage, 0.95);
  }
}

TEST(Decompose, SameForAnyThreadCountAndLimitHolds) {
  const core::TriangleMesh cup = shapes::Cup(.04, .1, .004, 32);
  DecompositionOptions options;
  options.max_parts = 9;
  core::SetThreadCount(1);
  const ConvexDecomposition one = Decompose(cup, options);
  core::SetThreadCount(3);
  const ConvexDecomposition three = Decompose(cup, options);
  core::SetThreadCount(0);
  EXPECT_LE(one.parts.size(), 9u);
  ASSERT_EQ(one.parts.size(), three.parts.size());
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    EXPECT_EQ(one.parts[i].hull.vertices, three.parts[i].hull.vertices);
    EXPECT_EQ(one.parts[i].concavity, three.parts[i].concavity);
  }
}

// A mug's function: a ball of 1 cm fits inside and stays, a rod of 6 mm passes through the handle.
TEST(Decompose, MugHoldsABallAndItsHandleARod) {
  SimplifyOptions thin;
  thin.face_budget = 3000;
  const core::TriangleMesh mug = Simplify(shapes::Mug(.0012), thin);
  const ConvexDecomposition d = Decompose(mug);
  ExpectConvexParts(d);
  EXPECT_GT(d.coverage, 0.97);
  const auto parts = Hulls(d);
  for (double z = 0.012; z < 0.12; z += 0.004) {
    EXPECT_GT(SignedDistanceToParts(parts, {{Vector3d(0, 0, z)}, 0.005}).distance, 0.0) << z;
  }
  // The same on the floor beside the wall; floor and walls support it.
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * shapes::kPi * i / 16;
    const Vector3d side(std::cos(a), std::sin(a), 0.0);
    const Vector3d up(0, 0, 0.05);
    EXPECT_GT(SignedDistanceToParts(parts, {{0.022 * side + up}, 0.005}).distance, 0.0) << i;
    EXPECT_LT(SignedDistanceToParts(parts, {{0.038 * side + up}, 0.005}).distance, 0.0) << i;
    const Vector3d floor = 0.02 * side + Vector3d(0, 0, 0.0025);
    EXPECT_LT(SignedDistanceToParts(parts, {{floor}, 0.005}).distance, 0.0) << i;
  }
  const ConvexShape rod{{Vector3d(.052, -.06, .048), Vector3d(.052, .06, .048)}, 0.003};
  EXPECT_GT(SignedDistanceToParts(parts, rod).distance, 0.0);
}

TEST(Decompose, FlatAndDisconnectedAndAwkwardSolids) {
  const core::TriangleMesh leaf =
      BoxUnion({BoxAt(0, 0, 0, 1, .001, 1), BoxAt(0, 0, 0, .3, .001, 2)});
  ExpectConvexParts(Decompose(leaf));
  core::TriangleMesh two = shapes::Box(1, 1, 1), other = two;
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(3, 0, 0)), &other);
  core::Append(other, &two);
  EXPECT_EQ(Decompose(two).parts.size(), 2u);
  DecompositionOptions one;
  one.max_parts = 1;
  EXPECT_EQ(Decompose(two, one).parts.size(), 1u);
  // Two intersecting boxes: self-intersecting, but closed.
  core::TriangleMesh crossing = shapes::Box(3, 1, 1), bar = shapes::Box(1, 3, 1);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(1, -1, 0.1)), &bar);
  core::Append(bar, &crossing);
  ExpectConvexParts(Decompose(crossing));
  const core::TriangleMesh torus = shapes::Torus(1.0, 0.3, 24, 12);
  const ConvexDecomposition unit = Decompose(torus);
  for (const double scale : {std::exp2(-30), std::exp2(30)}) {
    core::TriangleMesh scaled = torus;
    for (Vector3d& v : scaled.vertices) v *= scale;
    const ConvexDecomposition d = Decompose(scaled);
    ASSERT_EQ(d.parts.size(), unit.parts.size());
    for (std::size_t i = 0; i < d.parts.size(); ++i) {
      EXPECT_NEAR(
          SignedVolume(d.parts[i].hull) / std::pow(scale, 3) / SignedVolume(unit.parts[i].hull),
          1.0, 1e-9);
    }
  }
}

TEST(Decompose, RefusesBadInput) {
  EXPECT_THROW(Decompose({}), core::Error);
  core::TriangleMesh box = shapes::Box(1, 1, 1);
  DecompositionOptions options;
  options.threshold = -1.0;
  EXPECT_THROW(Decompose(box, options), core::Error);
  for (auto& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(Decompose(box), core::Error);
  box.vertices[0].x() = std::nan("");
  EXPECT_THROW(Decompose(box), core::Error);
}

// A cube as the only part of an L: just the protruding arm is missing.
TEST(MeasureDecomposition, KnowsExcessAndMissingVolume) {
  const core::TriangleMesh l = BoxUnion({BoxAt(0, 0, 0, 2, 1, 1), BoxAt(0, 0, 0, 1, 1, 2)});
  const double diagonal = 3.0;
  const DecompositionQuality hull = MeasureDecomposition(l, {ConvexHull(l.vertices)});
  EXPECT_NEAR(hull.excess_volume, 0.5 / 3.0, 0.01);
  EXPECT_EQ(hull.missing_volume, 0.0);
  // The crease's midpoint is 0.5 from the hull's ends and 1 / sqrt(2) from its slope; the midpoint
  // of that slope is 0.5 from either arm.
  EXPECT_NEAR(hull.solid_to_parts, 0.5 / diagonal, 0.01);
  EXPECT_NEAR(hull.parts_to_solid, 0.5 / diagonal, 0.01);
  EXPECT_LT(hull.uncovered, 1e-12);
  const DecompositionQuality cube = MeasureDecomposition(l, {shapes::Box(1, 1, 1)});
  EXPECT_NEAR(cube.missing_volume, 2.0 / 3.0, 0.01);
  EXPECT_EQ(cube.excess_volume, 0.0);
  EXPECT_NEAR(cube.solid_to_parts, 1.0 / diagonal, 0.01);
  EXPECT_NEAR(cube.uncovered, 1.0 / diagonal, 0.01);
  // Five of an L's fourteen unit squares touch the cube, minus those that face the arms.
  EXPECT_NEAR(cube.coverage, 4.0 / 14.0, 0.01);
}

TEST(Concavity, OfAnOpenBoxIsItsDepth) {
  const core::TriangleMesh tray =
      BoxUnion({BoxAt(0, 0, 0, 1, 1, .01), BoxAt(0, 0, 0, .01, 1, .2), BoxAt(.99, 0, 0, 1, 1, .2),
                BoxAt(0, 0, 0, 1, .01, .2), BoxAt(0, .99, 0, 1, 1, .2)});
  const core::TriangleMesh hull = ConvexHull(tray.vertices);
  EXPECT_NEAR(HausdorffToHull(tray, hull), 0.19, 0.005);
  const double radius = std::cbrt(3.0 * (0.2 - SignedVolume(tray)) / (4.0 * shapes::kPi));
  EXPECT_NEAR(Concavity(tray, hull), std::max(0.19, 0.3 * radius), 0.005);
}

}  // namespace
}  // namespace simwright::geometry
