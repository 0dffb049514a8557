#include "geometry/voxel_solid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "solid_shapes.h"

namespace simwright::geometry {
namespace {

TEST(VoxelSolid, FillsABoxToItsVolume) {
  const VoxelSolid solid(shapes::Box({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}), {.resolution = 64});
  EXPECT_NEAR(solid.Volume(), 1.0 * 0.6 * 0.4, 0.01 * 0.24);
  const VoxelSolid grown(shapes::Box({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}),
                         {.resolution = 64, .growth_cells = 0.5});
  const double more = 1.0 / 64;  // half a cell on either side
  EXPECT_NEAR(grown.Volume(), (1.0 + more) * (0.6 + more) * (0.4 + more), 0.01 * 0.24);
  EXPECT_EQ(solid.Occupancy({0, 0, 0}), 1.0f);
  EXPECT_EQ(solid.Occupancy({0.6, 0, 0}), 0.0f);
  EXPECT_EQ(solid.Occupancy({0, 0, 0.3}), 0.0f);
  EXPECT_EQ(solid.Occupancy({50, 0, 0}), 0.0f);
}

// Returns a cube of side 1 about the origin without its face towards `sign` z.
core::TriangleMesh OpenBox(double sign) {
  core::TriangleMesh box = shapes::Box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  std::erase_if(box.triangles, [&](const Eigen::Vector3i& t) {
    return sign * box.vertices[t[0]].z() > 0 && sign * box.vertices[t[1]].z() > 0 &&
           sign * box.vertices[t[2]].z() > 0;
  });
  return box;
}

TEST(VoxelSolid, AnOpenBoxIsAVesselNotABlock) {
  for (const double gap : {0.0, 3.0}) {
    const VoxelSolid solid(OpenBox(1.0), {.resolution = 48, .gap_cells = gap, .on_floor = true});
    EXPECT_EQ(solid.Occupancy({0, 0, 0}), 0.0f);
    EXPECT_GT(solid.Occupancy({0.5, 0, 0}), 0.5f);   // a wall
    EXPECT_GT(solid.Occupancy({0, 0, -0.5}), 0.5f);  // the floor
    EXPECT_EQ(solid.Occupancy({0, 0, 0.5}), 0.0f);   // no lid
  }
}

TEST(VoxelSolid, OnAFloorAnOpenUndersideIsClosed) {
  EXPECT_EQ(VoxelSolid(OpenBox(-1.0), {.resolution = 48}).Occupancy({0, 0, 0}), 0.0f);
  const VoxelSolid standing(OpenBox(-1.0), {.resolution = 48, .on_floor = true});
  EXPECT_EQ(standing.Occupancy({0, 0, 0}), 1.0f);
  EXPECT_EQ(standing.Occupancy({0, 0, -0.6}), 0.0f);
  EXPECT_NEAR(standing.Volume(), 1.0, 0.03);
}

TEST(VoxelSolid, NarrowOpeningsAreClosedWhereAskedFor) {
  // The lid leaves a slit of a twelfth of the side: 4 cells of 48.
  core::TriangleMesh box = OpenBox(1.0);
  core::Append(shapes::Box({-0.5 + 1.0 / 12, -0.5, 0.49}, {0.5, 0.5, 0.5}), &box);
  EXPECT_EQ(VoxelSolid(box, {.resolution = 48}).Occupancy({0, 0, 0}), 0.0f);
  EXPECT_EQ(VoxelSolid(box, {.resolution = 48, .gap_cells = 1.5}).Occupancy({0, 0, 0}), 0.0f);
  const VoxelSolid closed(box, {.resolution = 48, .gap_cells = 3.0});
  EXPECT_EQ(closed.Occupancy({0, 0, 0}), 1.0f);
  EXPECT_NEAR(closed.Volume(), 1.0, 0.05);
  // A ball keeps its volume: closing gaps does not enlarge convex shapes.
  const core::TriangleMesh ball = shapes::Sphere(0.5, 32);
  EXPECT_NEAR(VoxelSolid(ball, {.resolution = 48, .gap_cells = 3.0}).Volume(),
              VoxelSolid(ball, {.resolution = 48}).Volume(), 1e-12);
}

TEST(VoxelSolid, RefusesWhatHasNoExtentOrResolution) {
  EXPECT_THROW(VoxelSolid({}, {.resolution = 32}), core::Error);
  EXPECT_THROW(VoxelSolid(shapes::Box({0, 0, 0}, {1, 1, 1}), {.resolution = 4}), core::Error);
  EXPECT_THROW(VoxelSolid(shapes::Box({0, 0, 0}, {1, 1, 1}), {.gap_cells = -1.0}), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
