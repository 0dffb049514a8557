#include "geometry/mesh_validity.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

TriangleMesh Tetrahedron(const Vector3d& at, double size) {
  TriangleMesh mesh;
  mesh.vertices = {at, at + size * Vector3d::UnitX(), at + size * Vector3d::UnitY(),
                   at + size * Vector3d::UnitZ()};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TEST(MeshValidity, ATetrahedronIsSoundAndMeasured) {
  const MeshValidity state = Examine(Tetrahedron({1, 2, 3}, 2.0));
  EXPECT_TRUE(state.IsSolid());
  EXPECT_NEAR(state.signed_volume, 8.0 / 6.0, 1e-12);
  EXPECT_EQ(state.components, 1);
}

TEST(MeshValidity, FaultsAreNamed) {
  TriangleMesh open = Tetrahedron({0, 0, 0}, 1.0);
  open.triangles.pop_back();
  EXPECT_EQ(Examine(open).open_edges, 3);
  EXPECT_FALSE(Examine(open).closed);

  TriangleMesh inverted = Tetrahedron({0, 0, 0}, 1.0);
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(Examine(inverted).closed);
  EXPECT_FALSE(Examine(inverted).oriented);
  EXPECT_NEAR(Examine(inverted).signed_volume, -1.0 / 6.0, 1e-15);

  TriangleMesh one_turned = Tetrahedron({0, 0, 0}, 1.0);
  std::swap(one_turned.triangles[2][0], one_turned.triangles[2][1]);
  EXPECT_FALSE(Examine(one_turned).oriented);

  TriangleMesh crossing = Tetrahedron({0, 0, 0}, 1.0);
  core::Append(Tetrahedron({0.1, 0.1, 0.1}, 1.0), &crossing);
  EXPECT_GT(Examine(crossing).self_intersections, 0);
  EXPECT_EQ(Examine(crossing).components, 2);
}

// Two solids that share one vertex, then one edge.
TEST(MeshValidity, NonManifoldPlacesAreCounted) {
  TriangleMesh mesh = Tetrahedron({0, 0, 0}, 1.0);
  mesh.vertices.insert(mesh.vertices.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}});
  EXPECT_EQ(Examine(mesh).non_manifold_vertices, 1);
  EXPECT_EQ(Examine(mesh).self_intersections, 0);
  EXPECT_FALSE(Examine(mesh).manifold);

  TriangleMesh edge = Tetrahedron({0, 0, 0}, 1.0);
  edge.vertices.insert(edge.vertices.end(), {{-1, 0, 0}, {0, -1, 0}});
  edge.triangles.insert(edge.triangles.end(), {{0, 4, 5}, {0, 3, 4}, {0, 5, 3}, {3, 5, 4}});
  EXPECT_EQ(Examine(edge).non_manifold_edges, 1);
}

TEST(MeshValidity, HollowsFaceInward) {
  TriangleMesh shell = Tetrahedron({0, 0, 0}, 10.0);
  TriangleMesh hollow = Tetrahedron({1, 1, 1}, 1.0);
  TriangleMesh nested = shell;
  core::Append(hollow, &nested);
  EXPECT_FALSE(Examine(nested).oriented);
  for (auto& t : hollow.triangles) std::swap(t[0], t[1]);
  core::Append(hollow, &shell);
  EXPECT_TRUE(Examine(shell).IsSolid());
  EXPECT_NEAR(Examine(shell).signed_volume, 999.0 / 6.0, 1e-9);
}

// Faces that touch without a shared vertex, and one folded onto its neighbour.
TEST(MeshValidity, TouchingCountsAsCrossing) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(Examine(mesh).self_intersections, 1);
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(Examine(mesh).self_intersections, 1);
  mesh.vertices[3] = {1, -1, 0};
  EXPECT_EQ(Examine(mesh).self_intersections, 0);
}

TEST(MeshValidity, DegenerateFacesAndBadInput) {
  TriangleMesh mesh = Tetrahedron({0, 0, 0}, 1.0);
  mesh.vertices.push_back({0.5, 0, 0});
  mesh.triangles.push_back({0, 4, 1});
  EXPECT_EQ(Examine(mesh).degenerate_triangles, 1);
  EXPECT_FALSE(Examine({}).IsSolid());
  mesh.triangles.push_back({0, 1, 77});
  EXPECT_THROW(Examine(mesh), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
