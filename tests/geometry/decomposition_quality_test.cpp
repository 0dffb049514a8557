// Convex parts at a given number, under rounding of the input and within budgets, measured by
// geometry/concavity.h and closed forms.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "geometry/concavity.h"
#include "geometry/convex_decomposition.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"
#include "tests/sanitized.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using shapes::BoxAt;
using shapes::BoxUnion;

core::TriangleMesh Stairs() {
  return BoxUnion({BoxAt(0, 0, 0, .8, .5, .1), BoxAt(.2, 0, 0, .8, .5, .2),
                   BoxAt(.4, 0, 0, .8, .5, .3), BoxAt(.6, 0, 0, .8, .5, .4)});
}

// A seat, two front legs, two posts from floor to top and a back rest.
core::TriangleMesh Chair() {
  return BoxUnion({BoxAt(0, 0, .42, .42, .42, .46), BoxAt(0, 0, 0, .04, .04, .44),
                   BoxAt(.38, 0, 0, .42, .04, .44), BoxAt(0, .38, 0, .04, .42, .9),
                   BoxAt(.38, .38, 0, .42, .42, .9), BoxAt(0, .38, .7, .42, .42, .85)});
}

core::TriangleMesh Washer() {
  return shapes::Revolved({{.03, 0}, {.06, 0}, {.06, .01}, {.03, .01}}, 48);
}

ConvexDecomposition AtMost(const core::TriangleMesh& solid, int parts) {
  DecompositionOptions options;
  options.max_parts = parts;
  options.threshold = 1e-3;
  return Decompose(solid, options);
}

// Returns the concavity, with samples close enough together for thin walls.
double MeasuredConcavity(const core::TriangleMesh& solid, const ConvexDecomposition& parts) {
  ConcavityOptions fine;
  fine.surface_samples = 100000;
  fine.volume_samples = 1000;
  return MeasureDecomposition(solid, Hulls(parts), fine).concavity;
}

core::TriangleMesh Rotated(core::TriangleMesh mesh) {
  const Eigen::AngleAxisd turn(0.7, Vector3d(0.3, 0.5, 0.8).normalized());
  core::Transform(Eigen::Affine3d(turn), &mesh);
  return mesh;
}

// Unions of boxes are found exactly, also where boxes overlap and in any orientation.
TEST(DecomposeToCount, FindsExactPartsOfPolyhedra) {
  SKIP_UNDER_SANITIZERS();
  const core::TriangleMesh l = BoxUnion({BoxAt(0, 0, 0, 3, 1, 1), BoxAt(0, 0, 0, 1, 1, 3)});
  for (const auto& [solid, count] :
       {std::pair{l, 2}, std::pair{Stairs(), 4}, std::pair{Chair(), 6}}) {
    for (const core::TriangleMesh& mesh : {solid, Rotated(solid)}) {
      const ConvexDecomposition parts = AtMost(mesh, count);
      EXPECT_LE(static_cast<int>(parts.parts.size()), count);
      const DecompositionQuality quality = MeasureDecomposition(mesh, Hulls(parts));
      EXPECT_LT(quality.concavity, 1e-4) << count;
      EXPECT_LT(quality.volume_error, 1e-4) << count;
      EXPECT_LT(parts.deviation, 1e-4 * core::Bounds(mesh).diagonal().norm());
    }
  }
}

// Eight sectors of 45 degrees bury the inner wall by r (1 - cos 22.5 degrees); with ten parts the
// largest sector need not be larger.
TEST(DecomposeToCount, CutsARingIntoEvenSectors) {
  SKIP_UNDER_SANITIZERS();
  const core::TriangleMesh ring = Washer();
  const ConvexDecomposition parts = AtMost(ring, 10);
  EXPECT_LE(parts.parts.size(), 10u);
  const double sagitta = 0.03 * (1.0 - std::cos(shapes::kPi / 8.0));
  EXPECT_LT(parts.deviation, 1.05 * sagitta);
  const double diagonal = core::Bounds(ring).diagonal().norm();
  EXPECT_LT(MeasureDecomposition(ring, Hulls(parts)).concavity * diagonal, 1.05 * sagitta);
}

// A file with six digits, or noise of 1e-7 of the diagonal, hardly changes the quality: within a
// tenth or 1e-3 of the diagonal for flat and ring-like solids. The search on a thin curved wall has
// many results of similar quality: within 5e-3 of the diagonal.
TEST(DecomposeToCount, IsStableUnderRounding) {
  SKIP_UNDER_SANITIZERS();
  struct Case {
    core::TriangleMesh solid;
    int count;
    double slack;  // of the diagonal
  };
  const Case cases[] = {{Stairs(), 4, 1e-3},
                        {Chair(), 6, 1e-3},
                        {Washer(), 10, 1e-3},
                        {shapes::Cup(.04, .1, .004, 24), 12, 5e-3}};
  for (const auto& [solid, count, slack] : cases) {
    const double diagonal = core::Bounds(solid).diagonal().norm();
    const double before = MeasuredConcavity(solid, AtMost(solid, count));
    core::TriangleMesh written = solid, moved = solid;
    core::Rng rng(3);
    for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6g", solid.vertices[i][k]);
        written.vertices[i][k] = std::atof(digits);
        moved.vertices[i][k] += core::Uniform(rng, -1e-7, 1e-7) * diagonal;
      }
    }
    for (const core::TriangleMesh& mesh : {written, moved}) {
      const double after = MeasuredConcavity(solid, AtMost(mesh, count));
      EXPECT_NEAR(after, before, std::max(slack, 0.1 * before)) << count;
    }
  }
}

TEST(DecomposeWithin, ToleranceIsKeptAndCostsParts) {
  SKIP_UNDER_SANITIZERS();
  const core::TriangleMesh cup = shapes::Cup(.04, .1, .004, 32);
  const double diagonal = core::Bounds(cup).diagonal().norm();
  std::size_t coarser = 0;
  for (const double tolerance : {0.004, 0.001}) {
    DecompositionOptions options;
    options.tolerance = tolerance;
    options.max_hull_vertices = 256;
    const ConvexDecomposition parts = Decompose(cup, options);
    EXPECT_LT(parts.deviation, 1.02 * tolerance);
    const DecompositionQuality quality = MeasureDecomposition(cup, Hulls(parts));
    EXPECT_LT(quality.parts_to_solid * diagonal, 1.02 * tolerance);
    EXPECT_GT(parts.parts.size(), coarser);
    coarser = parts.parts.size();
  }
}

TEST(DecomposeWithin, VerticesAndFacesAreLimited) {
  DecompositionOptions options;
  options.max_hull_faces = 40;
  const core::TriangleMesh torus = shapes::Torus(1.0, 0.3, 24, 12);
  for (const ConvexPart& part : Decompose(torus, options).parts) {
    EXPECT_LE(part.hull.triangles.size(), 40u);
  }
  options.max_hull_faces = 0;
  options.max_hull_vertices = 20;
  for (const ConvexPart& part : Decompose(torus, options).parts) {
    EXPECT_LE(part.hull.vertices.size(), 20u);
  }
  options.max_hull_faces = 20;  // fewer than 16 vertices
  EXPECT_THROW(Decompose(torus, options), core::Error);
  options.max_hull_faces = 0;
  options.tolerance = -1.0;
  EXPECT_THROW(Decompose(torus, options), core::Error);
}

// Two cubes side by side add no volume, a third at a distance of 1 adds that gap.
TEST(MergeHulls, JoinsWhatAddsTheLeastVolume) {
  const std::vector<core::TriangleMesh> cubes{shapes::Box(Vector3d(3, 0, 0), Vector3d(4, 1, 1)),
                                              shapes::Box(Vector3d(0, 0, 0), Vector3d(1, 1, 1)),
                                              shapes::Box(Vector3d(1, 0, 0), Vector3d(2, 1, 1))};
  std::vector<double> volumes;
  for (const core::TriangleMesh& part : MergeHulls(cubes, 2, 64)) {
    volumes.push_back(SignedVolume(part));
  }
  std::sort(volumes.begin(), volumes.end());
  ASSERT_EQ(volumes.size(), 2u);
  EXPECT_NEAR(volumes[0], 1.0, 1e-9);
  EXPECT_NEAR(volumes[1], 2.0, 1e-9);
  const std::vector<core::TriangleMesh> one = MergeHulls(cubes, 1, 64);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_NEAR(SignedVolume(one[0]), 4.0, 1e-9);
  EXPECT_EQ(MergeHulls(cubes, 3, 64).size(), 3u);
  EXPECT_THROW(MergeHulls(cubes, 0, 64), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
