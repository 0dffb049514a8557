#include "twin/table_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "library_fit/fit_kinds.h"
#include "twin/table_camera.h"

namespace simwright::twin {
namespace {

core::TriangleMesh MeshOf(const char* kind, std::uint64_t seed) {
  return library_fit::InstanceMesh(
             library_fit::SampleInstance(library_fit::FindFitKind(kind), seed))
      .mesh;
}

TEST(PoseFromBox, FindsWhereAndHowLargeAnObjectStands) {
  const core::Camera camera = TableCamera{0.6, 0.05, 1.1, 0.7}.At(640, 480);
  int tested = 0;
  for (const char* kind : {"mug", "cereal_box", "plate", "bottle", "spoon"}) {
    for (const double yaw : {0.3, 2.0}) {
      const core::TriangleMesh mesh = MeshOf(kind, 5);
      const ScaledPose truth{{0.12 - 0.1 * tested / 10.0, 0.9 + 0.02 * tested, yaw}, 1.3};
      const Eigen::AlignedBox2d box = ProjectedBox(mesh, truth, camera);
      ASSERT_FALSE(box.isEmpty());
      const ScaledPose found = PoseFromBox(mesh, yaw, camera, box);
      EXPECT_NEAR(found.pose.x, truth.pose.x, 1e-3) << kind;
      EXPECT_NEAR(found.pose.y, truth.pose.y, 1e-3) << kind;
      EXPECT_NEAR(found.scale, truth.scale, 5e-3) << kind;
      ++tested;
    }
  }
  EXPECT_EQ(tested, 10);
}

TEST(ProjectedBox, IsEmptyBehindTheCamera) {
  const core::Camera camera = TableCamera{0.6, 0.0, 1.1, 0.7}.At(640, 480);
  EXPECT_TRUE(ProjectedBox(MeshOf("mug", 1), {{0.0, -3.0, 0.0}, 1.0}, camera).isEmpty());
}

// A box above the horizon has no place on the table: the answer stays finite.
TEST(PoseFromBox, StaysFiniteAboveTheHorizon) {
  const core::Camera camera = TableCamera{0.1, 0.0, 1.1, 0.7}.At(640, 480);
  const ScaledPose pose =
      PoseFromBox(MeshOf("mug", 1), 0.0, camera, {Eigen::Vector2d(10, 5), Eigen::Vector2d(40, 45)});
  EXPECT_TRUE(std::isfinite(pose.pose.x) && std::isfinite(pose.pose.y));
  EXPECT_GT(pose.scale, 0.0);
}

}  // namespace
}  // namespace simwright::twin
