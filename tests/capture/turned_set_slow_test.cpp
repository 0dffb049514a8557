// Two sets of photos of one object that was turned over between them, on rendered photos.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "capture/capture.h"
#include "capture/turned_set.h"
#include "geometry/mass_properties.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

void AddBox(const Eigen::Vector3d& sides, const Eigen::Vector3d& at, std::uint64_t seed,
            core::TexturedMesh* object) {
  core::TexturedMesh box = PaintedBox(sides, seed);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(at)), &box.mesh);
  core::Append(box.mesh, &object->mesh);
  object->corner_uvs.insert(object->corner_uvs.end(), box.corner_uvs.begin(), box.corner_uvs.end());
  for (const int material : box.triangle_material) {
    object->triangle_material.push_back(material + static_cast<int>(object->materials.size()));
  }
  for (core::Material material : box.materials) {
    material.texture += static_cast<int>(object->textures.size());
    object->materials.push_back(material);
  }
  // The textures follow the materials, whose indices are shifted by those before.
  object->textures.insert(object->textures.end(), box.textures.begin(), box.textures.end());
}

Capture CaptureOf(const core::TexturedMesh& object, std::uint64_t seed) {
  MatPhotoOptions options;
  options.lens = PhoneLens(900, 675, 65 * kRadians);
  options.samples_per_side = 1;
  options.seed = seed;
  const auto poses =
      OrbitPoses(12, {18 * kRadians, 38 * kRadians, 60 * kRadians}, 0.13, options.lens, seed);
  const std::vector<MatPhoto> photos = RenderMatPhotos(object, poses, options);
  CaptureSource source;
  for (std::size_t i = 0; i < photos.size(); ++i) source.photos.push_back({std::to_string(i), 0.0});
  source.read = [&](int i) { return photos[static_cast<std::size_t>(i)].photo; };
  CaptureOptions capture;
  capture.first_side = 320;
  capture.crop_side = 420;
  capture.hull_cells = 88;
  core::Progress silent;
  return CaptureOnMat(source, capture, &silent);
}

core::TexturedMesh Turned(core::TexturedMesh object, const Eigen::Isometry3d& pose) {
  core::Transform(Eigen::Affine3d(pose.matrix()), &object.mesh);
  return object;
}

// Returns the pose that turns an object about the x axis, then about the vertical, and stands it on
// the mat near its middle.
Eigen::Isometry3d Standing(const core::TexturedMesh& object, double about_x, double about_z) {
  Eigen::Isometry3d turn(Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()));
  const Eigen::AlignedBox3d box = core::Bounds(Turned(object, turn).mesh);
  return Eigen::Translation3d(0.006 - box.center().x(), -0.004 - box.center().y(), -box.min().z()) *
         turn;
}

void ExpectPose(const TurnedPose& found, const Eigen::Isometry3d& second_from_first,
                const core::TexturedMesh& object) {
  const Eigen::Isometry3d error = found.first_from_second * second_from_first;
  const Eigen::AlignedBox3d box = core::Bounds(object.mesh);
  const double degrees = Eigen::AngleAxisd(error.linear()).angle() / kRadians;
  const double percent =
      100.0 * (error * box.center() - box.center()).norm() / box.diagonal().norm();
  std::printf(
      "rotation %.2f degrees, translation %.2f %%, outlines %.3f, colours %.3f, rival %.3f\n",
      degrees, percent, found.agreement, found.color_difference,
      found.rival_difference.value_or(-1.0));
  EXPECT_LT(degrees, 1.0);
  EXPECT_LT(percent, 0.8);
  EXPECT_EQ(found.doubt, "");
}

core::TexturedMesh Steps() {
  core::TexturedMesh object;
  AddBox({0.09, 0.055, 0.03}, {0, 0, 0}, 3, &object);
  AddBox({0.035, 0.055, 0.035}, {-0.0275, 0, 0.03}, 4, &object);
  return object;
}

constexpr double kStepsVolume = 0.09 * 0.055 * 0.03 + 0.035 * 0.055 * 0.035;

double VolumeOf(const core::TriangleMesh& mesh) {
  return geometry::SolidMassProperties(mesh, 1.0).mass;
}

TEST(TurnedSet, FindsThePoseOfAnObjectOnItsSideAndItsUnderside) {
  const core::TexturedMesh object = Steps();
  const Eigen::Isometry3d pose = Standing(object, 0.5 * std::numbers::pi, 0.7);
  Capture first = CaptureOf(object, 5);
  const Capture second = CaptureOf(Turned(object, pose), 6);
  core::Progress silent;
  const TurnedPose found = FindTurnedPose(first, second, 1, &silent);
  ExpectPose(found, pose, object);
  const std::size_t before = first.views.size();
  const double excess = VolumeOf(first.hull) / kStepsVolume - 1.0;
  MergeTurned(second, found.first_from_second, 12, {}, &first);
  ASSERT_EQ(first.views.size(), before + second.views.size());
  ASSERT_EQ(first.calibration.views.size(), first.views.size());
  const double left = VolumeOf(first.hull) / kStepsVolume - 1.0;
  std::printf("excess volume %.3f, with both sets %.3f\n", excess, left);
  EXPECT_LT(left, 0.7 * excess);
  // Eleven photos from above do not show that the tops are flat: the hull of the true outlines is
  // 69.3 mm high.
  EXPECT_NEAR(core::Bounds(first.hull).sizes().z(), 0.065, 0.0045);
  EXPECT_GE(first.views.back().index, 12);
}

// Outlines do not distinguish the ends of a box: its pictures do.
TEST(TurnedSet, ColoursDecideWhereOutlinesDoNot) {
  const core::TexturedMesh object = PaintedBox({0.09, 0.06, 0.04}, 8);
  const Eigen::Isometry3d pose = Standing(object, std::numbers::pi, -0.4);
  core::Progress silent;
  ExpectPose(FindTurnedPose(CaptureOf(object, 5), CaptureOf(Turned(object, pose), 6), 1, &silent),
             pose, object);
}

TEST(TurnedSet, DoubtsTwoObjects) {
  core::Progress silent;
  const TurnedPose found = FindTurnedPose(
      CaptureOf(Steps(), 5), CaptureOf(PaintedBox({0.06, 0.06, 0.06}, 8), 6), 1, &silent);
  std::printf("outlines %.3f: %s\n", found.agreement, found.doubt.c_str());
  EXPECT_NE(found.doubt, "");
}

}  // namespace
}  // namespace simwright::capture
