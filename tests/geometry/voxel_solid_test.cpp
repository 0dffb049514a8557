#include "geometry/voxel_solid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "solid_shapes.h"

namespace simwright::geometry {
namespace {

TEST(VoxelSolid, FillsABoxToItsVolume) {
  const VoxelSolid solid(shapes::Box({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}), 64);
  EXPECT_NEAR(solid.Volume(), 1.0 * 0.6 * 0.4, 0.01 * 0.24);
  const VoxelSolid grown(shapes::Box({-0.5, -0.3, -0.2}, {0.5, 0.3, 0.2}), 64, 1.5, 0.5);
  const double more = 1.0 / 64;  // half a cell on either side
  EXPECT_NEAR(grown.Volume(), (1.0 + more) * (0.6 + more) * (0.4 + more), 0.01 * 0.24);
  EXPECT_EQ(solid.Occupancy({0, 0, 0}), 1.0f);
  EXPECT_EQ(solid.Occupancy({0.6, 0, 0}), 0.0f);
  EXPECT_EQ(solid.Occupancy({0, 0, 0.3}), 0.0f);
  EXPECT_EQ(solid.Occupancy({50, 0, 0}), 0.0f);
}

TEST(VoxelSolid, AnOpenBoxIsAVesselNotABlock) {
  core::TriangleMesh box = shapes::Box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  std::erase_if(box.triangles, [&](const Eigen::Vector3i& t) {
    return box.vertices[t[0]].z() > 0 && box.vertices[t[1]].z() > 0 && box.vertices[t[2]].z() > 0;
  });
  const VoxelSolid solid(box, 48);
  EXPECT_EQ(solid.Occupancy({0, 0, 0}), 0.0f);
  EXPECT_GT(solid.Occupancy({0.5, 0, 0}), 0.5f);   // a wall
  EXPECT_GT(solid.Occupancy({0, 0, -0.5}), 0.5f);  // the floor
  EXPECT_EQ(solid.Occupancy({0, 0, 0.5}), 0.0f);   // no lid
}

TEST(VoxelSolid, RefusesWhatHasNoExtentOrResolution) {
  EXPECT_THROW(VoxelSolid({}, 32), core::Error);
  EXPECT_THROW(VoxelSolid(shapes::Box({0, 0, 0}, {1, 1, 1}), 4), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
