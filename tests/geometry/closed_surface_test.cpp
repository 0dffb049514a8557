// Closed surfaces, open ones, and those whose vertices repeat.
#include "geometry/closed_surface.h"

#include <gtest/gtest.h>

namespace simwright::geometry {
namespace {

core::TriangleMesh Tetrahedron() {
  core::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TEST(ClosedSurface, ATetrahedronIsClosed) {
  core::TriangleMesh mesh = Tetrahedron();
  EXPECT_TRUE(IsClosed(mesh));
  // Each face with vertices of its own.
  core::TriangleMesh soup;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int corner : triangle) {
      soup.vertices.push_back(mesh.vertices[static_cast<size_t>(corner)]);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(IsClosed(soup));
  // Two that share a face.
  core::Append(mesh, &mesh);
  EXPECT_TRUE(IsClosed(mesh));
}

TEST(ClosedSurface, MissingAndFlippedFacesAreSeen) {
  core::TriangleMesh open = Tetrahedron(), flipped = Tetrahedron();
  open.triangles.pop_back();
  EXPECT_FALSE(IsClosed(open));
  std::swap(flipped.triangles[0].x(), flipped.triangles[0].y());
  EXPECT_FALSE(IsClosed(flipped));
  EXPECT_FALSE(IsClosed({}));
}

}  // namespace
}  // namespace simwright::geometry
