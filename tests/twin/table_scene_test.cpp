#include "twin/table_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/error.h"
#include "twin/detector_example.h"
#include "twin/table_picture.h"

namespace simwright::twin {
namespace {

TEST(TableScene, ObjectsStandApartOnTheTable) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    core::Rng rng(seed);
    const TableScene scene = SampleTableScene({}, {}, &rng);
    ASSERT_GE(scene.objects.size(), 1u);
    EXPECT_LE(scene.objects.size(), 8u);
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const TableObject& object : scene.objects) {
      core::TriangleMesh placed = object.visual.mesh;
      core::Transform(Eigen::Affine3d(object.world_from_object), &placed);
      boxes.push_back(core::Bounds(placed));
      EXPECT_NEAR(boxes.back().min().z(), 0.0, 1e-6);
      if (scene.table.endless || scene.table.round) continue;
      const Eigen::Vector2d middle =
          Eigen::Rotation2Dd(-scene.table.yaw) * boxes.back().center().head<2>();
      EXPECT_LT(std::abs(middle.x()), scene.table.half.x());
      EXPECT_LT(std::abs(middle.y()), scene.table.half.y());
    }
    EXPECT_GT(scene.camera.position().z(), 0.0);
  }
}

TEST(TableScene, HeldOutSeedsAreOthers) {
  TableSceneOptions options;
  options.first_seed = 1'000'000'000;
  options.seeds = 1000;
  core::Rng rng(3);
  const TableScene scene = SampleTableScene({}, options, &rng);
  for (const TableObject& object : scene.objects) {
    EXPECT_GE(object.instance.seed, options.first_seed);
  }
  options.most_objects = 0;
  EXPECT_THROW(SampleTableScene({}, options, &rng), core::Error);
}

// A label's pixels lie within the projected bounds of its object, and a depth is that of a point in
// the object's bounds.
TEST(TablePicture, LabelsAndDepthsAreThoseOfTheObjects) {
  core::Rng rng(5);
  const TableScene scene = SampleTableScene({}, {}, &rng);
  const TablePicture picture = RenderTable(scene, {}, {2, 4, 2}, 1);
  const core::Camera& camera = scene.camera;
  ASSERT_EQ(picture.label.size(), static_cast<size_t>(camera.width) * camera.height);
  std::set<int> seen;
  int inside = 0, all = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const size_t at = static_cast<size_t>(y) * camera.width + x;
      const int label = picture.label[at];
      if (label == kTableLabel) {
        // A ray through the pixel meets the board at that depth.
        const Eigen::Vector3d point =
            camera.position() + picture.depth[at] * camera.Ray({x + 0.5, y + 0.5});
        EXPECT_LT(point.z(), 0.02);
        continue;
      }
      if (label < 0) continue;
      seen.insert(label);
      const TableObject& object = scene.objects[static_cast<size_t>(label)];
      const Eigen::Vector3d point =
          object.world_from_object.inverse() *
          (camera.position() + picture.depth[at] * camera.Ray({x + 0.5, y + 0.5}));
      Eigen::AlignedBox3d box = core::Bounds(object.visual.mesh);
      box.min().array() -= 0.01;
      box.max().array() += 0.01;
      inside += box.contains(point) ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GE(seen.size(), 2u);
  EXPECT_GT(inside, 0.97 * all);
}

TEST(DetectorExample, IsAFunctionOfItsSeed) {
  TableSceneOptions options;
  options.width = 64;
  options.height = 64;
  const DetectorExample a = MakeDetectorExample({}, options, 9);
  const DetectorExample b = MakeDetectorExample({}, options, 9);
  EXPECT_EQ(a.picture, b.picture);
  EXPECT_EQ(a.object, b.object);
  EXPECT_NE(a.picture, MakeDetectorExample({}, options, 10).picture);
}

}  // namespace
}  // namespace simwright::twin
