#include "geometry/solid.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/mesh_validity.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"
#include "tests/sanitized.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using shapes::Box;

TriangleMesh Torus(double major, double minor, int around, int tube) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < tube; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around;
      const double v = 2.0 * std::numbers::pi * j / tube;
      const double r = major + minor * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
      const int a = i * tube + j;
      const int b = (i + 1) % around * tube + j;
      const int c = (i + 1) % around * tube + (j + 1) % tube;
      const int d = i * tube + (j + 1) % tube;
      mesh.triangles.emplace_back(a, b, c);
      mesh.triangles.emplace_back(a, c, d);
    }
  }
  return mesh;
}

void TurnRound(TriangleMesh* mesh) {
  for (auto& t : mesh->triangles) std::swap(t[1], t[2]);
}

void ExpectAccepted(const TriangleMesh& visual, const Solid& solid, double tolerance = 0.005) {
  const MeshValidity state = Examine(solid.mesh);
  EXPECT_TRUE(state.IsSolid()) << Describe(state);
  EXPECT_LE(OuterSurfaceDistance(visual, solid.mesh).MaxRatio(), tolerance);
}

// An eighth of the grid's nodes, for properties that do not depend on its resolution.
SolidOptions Coarse() {
  SolidOptions options;
  options.face_budget = 5000;
  options.tolerance_ratio *= 2.0;
  options.sheet_thickness_ratio *= 2.0;
  options.cell_ratio *= 2.0;
  return options;
}

TEST(Solid, ClosedMeshesStayAsTheyAre) {
  const TriangleMesh box = Box({0, 0, 0}, {1, 2, 3});
  const Solid solid = MakeSolid(box);
  EXPECT_EQ(solid.method, SolidMethod::kAsItIs);
  EXPECT_EQ(solid.sheet_thickness, 0.0);
  EXPECT_NEAR(SignedVolume(solid.mesh), 6.0, 1e-12);
  const TriangleMesh torus = Torus(1.0, 0.3, 96, 48);
  const Solid ring = MakeSolid(torus);
  EXPECT_EQ(ring.method, SolidMethod::kAsItIs);
  // For polygons inscribed in the tube; 2 pi^2 R r^2 in the limit.
  EXPECT_NEAR(SignedVolume(ring.mesh), 2.0 * std::pow(std::numbers::pi, 2) * 0.09, 0.01);
  EXPECT_EQ(SignedVolume(ring.mesh), SignedVolume(torus));
}

TEST(Solid, InsideOutAndDoubledFacesAreMended) {
  TriangleMesh box = Box({0, 0, 0}, {1, 1, 1});
  TurnRound(&box);
  EXPECT_NEAR(SignedVolume(MakeSolid(box).mesh), 1.0, 1e-12);
  TriangleMesh doubled = box;
  core::Append(Box({0, 0, 0}, {1, 1, 1}), &doubled);
  const Solid solid = MakeSolid(doubled);
  EXPECT_EQ(solid.method, SolidMethod::kRepaired);
  EXPECT_NEAR(SignedVolume(solid.mesh), 1.0, 1e-12);
  EXPECT_EQ(solid.mesh.triangles.size(), 12u);
  TriangleMesh mixed = Torus(1.0, 0.3, 20, 12);
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3) {
    std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  }
  EXPECT_NEAR(SignedVolume(MakeSolid(mixed).mesh), SignedVolume(Torus(1.0, 0.3, 20, 12)), 1e-12);
}

TEST(Solid, InnerShellsAreDroppedAndNeighboursKept) {
  TriangleMesh nested = Box({0, 0, 0}, {4, 4, 4});
  core::Append(Box({1, 1, 1}, {2, 2, 2}), &nested);
  core::Append(Box({5, 0, 0}, {6, 1, 1}), &nested);
  const Solid solid = MakeSolid(nested);
  EXPECT_EQ(solid.method, SolidMethod::kRepaired);
  EXPECT_NEAR(SignedVolume(solid.mesh), 65.0, 1e-12);
}

TEST(Solid, CrossingBoxesBecomeTheirUnion) {
  SKIP_UNDER_SANITIZERS();
  TriangleMesh boxes = Box({0, 0, 0}, {2, 1, 1});
  core::Append(Box({1, 0.25, 0.5}, {3, 0.75, 2}), &boxes);
  const Solid solid = MakeSolid(boxes);
  ExpectAccepted(boxes, solid);
  EXPECT_EQ(Examine(solid.mesh).components, 1);
  // 2 + 1.5 - the common 1 x 0.5 x 0.5.
  EXPECT_NEAR(SignedVolume(solid.mesh), 3.25, 0.03);
}

TEST(Solid, OpenSheetsGetAWall) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Solid solid = MakeSolid(sheet);
  EXPECT_EQ(solid.method, SolidMethod::kWrapped);
  EXPECT_NEAR(solid.sheet_thickness, 0.005 * std::sqrt(2.0), 1e-12);
  ExpectAccepted(sheet, solid);
  // The plate and its rounded rim: area * wall + half a tube around it.
  const double w = solid.sheet_thickness;
  const double expected = w + 4.0 * std::numbers::pi * w * w / 8.0;
  EXPECT_NEAR(SignedVolume(solid.mesh), expected, 0.05 * expected);
  EXPECT_EQ(Examine(solid.mesh).components, 1);
}

TEST(Solid, ABoxWithoutALidIsAVessel) {
  SKIP_UNDER_SANITIZERS();
  TriangleMesh open = Box({0, 0, 0}, {1, 1, 1});
  open.triangles.erase(open.triangles.begin() + 2, open.triangles.begin() + 4);
  const Solid solid = MakeSolid(open);
  ExpectAccepted(open, solid);
  const double w = solid.sheet_thickness;
  EXPECT_NEAR(SignedVolume(solid.mesh), 5.0 * w, 0.06 * 5.0 * w);
}

TEST(Solid, ACrackTooNarrowToSeeIntoStaysClosed) {
  TriangleMesh box = Box({0, 0, 0}, {1, 1, 1});
  // The lid is shifted by 2e-5 of the diagonal and shares no vertex with the sides any more.
  const int first = static_cast<int>(box.vertices.size());
  for (const int c : {4, 5, 6, 7}) {
    box.vertices.push_back(box.vertices[c] + Vector3d(2e-5, 3e-5, 1e-5));
  }
  box.triangles[2] = {first, first + 1, first + 2};
  box.triangles[3] = {first + 1, first + 3, first + 2};
  const Solid solid = MakeSolid(box);
  ExpectAccepted(box, solid);
  EXPECT_NEAR(SignedVolume(solid.mesh), 1.0, 0.01);
}

TEST(Solid, ASingleTriangleAndASoupBecomeSolids) {
  TriangleMesh one;
  one.vertices = {{0, 0, 0}, {1, 0, 0.2}, {0.3, 0.8, 0}};
  one.triangles = {{0, 1, 2}};
  ExpectAccepted(one, MakeSolid(one));
  core::Rng rng(5);
  TriangleMesh soup;
  for (int t = 0; t < 40; ++t) {
    const Vector3d center(core::Uniform(rng), core::Uniform(rng), core::Uniform(rng));
    for (int c = 0; c < 3; ++c) {
      soup.vertices.push_back(center + 0.3 * core::UniformDirection(rng));
    }
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  ExpectAccepted(soup, MakeSolid(soup, Coarse()), 0.01);
}

TEST(Solid, ScaleAndPlaceDoNotMatter) {
  SKIP_UNDER_SANITIZERS();
  TriangleMesh boxes = Box({0, 0, 0}, {2, 1, 1});
  core::Append(Box({1, 0.25, 0.5}, {3, 0.75, 2}), &boxes);
  for (const double scale : {1e-9, 1e9}) {
    TriangleMesh scaled = boxes;
    for (Vector3d& v : scaled.vertices) v = scale * (v + Vector3d(10, -20, 30));
    const Solid solid = MakeSolid(scaled, Coarse());
    ExpectAccepted(scaled, solid, 0.01);
    EXPECT_NEAR(SignedVolume(solid.mesh) / std::pow(scale, 3), 3.25, 0.06);
  }
}

TEST(Solid, ThreadsDoNotMatter) {
  SKIP_UNDER_SANITIZERS();
  TriangleMesh boxes = Box({0, 0, 0}, {2, 1, 1});
  core::Append(Torus(1.0, 0.3, 30, 12), &boxes);
  core::SetThreadCount(1);
  const Solid one = MakeSolid(boxes, Coarse());
  core::SetThreadCount(3);
  const Solid three = MakeSolid(boxes, Coarse());
  core::SetThreadCount(0);
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
}

TEST(Solid, BadInputIsRefused) {
  EXPECT_THROW(MakeSolid({}), core::Error);
  TriangleMesh point;
  point.vertices = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  point.triangles = {{0, 1, 2}};
  EXPECT_THROW(MakeSolid(point), core::Error);
  TriangleMesh broken = Box({0, 0, 0}, {1, 1, 1});
  broken.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(MakeSolid(broken), core::Error);
  broken = Box({0, 0, 0}, {1, 1, 1});
  broken.triangles[0][0] = 99;
  EXPECT_THROW(MakeSolid(broken), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
