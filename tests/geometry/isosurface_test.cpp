#include "geometry/isosurface.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "geometry/mesh_validity.h"

namespace simwright::geometry {
namespace {

ScalarGrid Grid(int n) {
  ScalarGrid grid;
  grid.nx = grid.ny = grid.nz = n;
  grid.cell = 2.0 / (n - 1);
  grid.origin.setConstant(-1.0);
  grid.values.resize(static_cast<std::size_t>(n) * n * n);
  return grid;
}

TEST(Isosurface, SphereHasItsVolume) {
  ScalarGrid grid = Grid(61);
  for (int k = 0; k < 61; ++k) {
    for (int j = 0; j < 61; ++j) {
      for (int i = 0; i < 61; ++i) {
        const Eigen::Vector3d p = grid.origin + grid.cell * Eigen::Vector3d(i, j, k);
        grid.values[grid.Index(i, j, k)] = static_cast<float>(p.norm() - 0.7);
      }
    }
  }
  const core::TriangleMesh mesh = ExtractIsosurface(grid, 0.0f);
  const MeshValidity state = Examine(mesh);
  EXPECT_TRUE(state.IsSolid()) << Describe(state);
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(0.7, 3);
  EXPECT_NEAR(state.signed_volume, volume, 0.003 * volume);
  for (const Eigen::Vector3d& v : mesh.vertices) EXPECT_NEAR(v.norm(), 0.7, 0.001);
}

// Every pattern of signs, including ambiguous ones, and a surface that meets the border.
TEST(Isosurface, NoiseGivesASoundMesh) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Rng rng(seed);
    ScalarGrid grid = Grid(16);
    for (float& v : grid.values) v = static_cast<float>(core::Uniform(rng, -1.0, 1.0));
    const MeshValidity state = Examine(ExtractIsosurface(grid, 0.1f));
    EXPECT_TRUE(state.closed && state.manifold) << Describe(state);
    EXPECT_EQ(state.self_intersections, 0);
    EXPECT_EQ(state.degenerate_triangles, 0);
    EXPECT_TRUE(state.oriented) << Describe(state);
  }
}

TEST(Isosurface, EmptyFullAndBadFields) {
  ScalarGrid grid = Grid(5);
  std::fill(grid.values.begin(), grid.values.end(), 1.0f);
  EXPECT_TRUE(ExtractIsosurface(grid, 0.0f).empty());
  std::fill(grid.values.begin(), grid.values.end(), -1.0f);
  EXPECT_TRUE(Examine(ExtractIsosurface(grid, 0.0f)).IsSolid());
  std::fill(grid.values.begin(), grid.values.end(), std::nanf(""));
  EXPECT_TRUE(ExtractIsosurface(grid, 0.0f).empty());
  grid.values.pop_back();
  EXPECT_THROW(ExtractIsosurface(grid, 0.0f), core::Error);
  grid.nx = 1;
  EXPECT_THROW(ExtractIsosurface(grid, 0.0f), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
