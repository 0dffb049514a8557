// Cameras of dataset scenes against closed forms and RenderForward.
#include "scene/export/scene_cameras.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "render/forward.h"

namespace simwright::scene {
namespace {

sim::RigidBody SolidOf(const core::TriangleMesh& mesh) {
  sim::RigidBody body;
  body.inertial.mass = 1.0;
  body.inertial.inertia = 0.01 * Eigen::Matrix3d::Identity();
  body.parts = {mesh};
  return body;
}

AssetSet BlocksAndBalls() {
  AssetSet asset_set;
  core::TriangleMesh block = assets::BoxMesh({0.4, 0.2, 0.1}), ball = assets::SphereMesh(0.1);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.0, 0.0, 0.05)), &block);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.0, 0.0, 0.1)), &ball);
  asset_set.Add("block", SolidOf(block));
  asset_set.Add("ball", SolidOf(ball));
  return asset_set;
}

std::vector<SceneObject> BallOnBlock() {
  std::vector<SceneObject> objects(3);
  objects[0].category = objects[2].category = "block";
  objects[1].category = "ball";
  objects[1].world_from_object.translation() = Eigen::Vector3d(0.1, 0.02, 0.1);
  objects[2].world_from_object =
      Eigen::Translation3d(-0.3, 0.3, 0.0) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  return objects;
}

render::CameraSpec SceneSpec(const std::string& name, const Eigen::Vector3d& position) {
  render::CameraSpec spec;
  spec.name = name;
  spec.width = 100, spec.height = 80;
  spec.mount_from_camera = render::LookAt(position, {0.0, 0.05, 0.1});
  return spec;
}

struct SceneImage {
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(3 * 8000);
  std::vector<float> depth = std::vector<float>(8000), normal = std::vector<float>(3 * 8000);
  std::vector<std::int32_t> label = std::vector<std::int32_t>(8000);
  render::ImageBuffers Buffers() { return {rgb.data(), depth.data(), label.data(), normal.data()}; }
  bool operator==(const SceneImage&) const = default;
};

TEST(SceneCameras, AgreeWithRenderForwardAndTheFloor) {
  const AssetSet asset_set = BlocksAndBalls();
  const render::CameraSpec spec = SceneSpec("side", {0.9, -0.6, 0.7});
  const SceneCameras cameras(asset_set, {"block", "ball"}, {spec});
  const std::vector<SceneObject> objects = BallOnBlock();
  SceneImage image;
  cameras.Render(objects, 0, {image.Buffers()});
  render::Scene scene;
  for (const SceneObject& object : objects) {
    scene.Add(&asset_set.At(object.category).visual, object.world_from_object);
  }
  scene.Commit();
  const core::Camera eye = render::CameraAt(spec, Eigen::Isometry3d::Identity());
  const render::ForwardBuffers forward = render::RenderForward(scene, eye);
  int other = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 100; ++x) {
      const std::size_t i = forward.Index(x, y);
      const std::int32_t expected = forward.label[i] + 1;  // the floor is everywhere else
      if (image.label[i] != expected) {
        ++other;
        continue;
      }
      const Eigen::Vector3d ray = eye.Ray({x + 0.5, y + 0.5});
      const double depth =
          expected > 0 ? forward.depth[i] : (-0.0005 - eye.position().z()) / ray.z();
      EXPECT_NEAR(image.depth[i], depth, 3e-5);
    }
  }
  EXPECT_LE(other, 10);
  for (int object = 0; object < 3; ++object) {
    EXPECT_GT(std::count(image.label.begin(), image.label.end(), SceneObjectLabel(object)), 100);
  }
}

TEST(SceneCameras, BatchesGiveTheImagesOfSingleScenes) {
  const AssetSet asset_set = BlocksAndBalls();
  SceneCamerasOptions options;
  options.look = render::LookRanges::Wide();
  const SceneCameras cameras(
      asset_set, {"block", "ball"},
      {SceneSpec("side", {0.9, -0.6, 0.7}), SceneSpec("other side", {-0.9, -0.6, 0.7})}, options);
  std::vector<SceneObject> moved = BallOnBlock();
  moved[1].world_from_object.translation().y() += 0.2;
  std::vector<SceneImage> batch(4), single(4);
  std::vector<render::ImageBuffers> buffers;
  for (SceneImage& image : batch) buffers.push_back(image.Buffers());
  cameras.RenderScenes({BallOnBlock(), moved}, 40, buffers);
  cameras.Render(BallOnBlock(), 40, {single[0].Buffers(), single[1].Buffers()});
  cameras.Render(moved, 41, {single[2].Buffers(), single[3].Buffers()});
  EXPECT_EQ(batch, single);
  EXPECT_NE(batch[0].rgb, batch[2].rgb);
}

TEST(SceneCameras, RefuseBadInput) {
  const AssetSet asset_set = BlocksAndBalls();
  render::CameraSpec spec = SceneSpec("side", {0.9, -0.6, 0.7});
  const SceneCameras cameras(asset_set, {"ball"}, {spec});
  SceneImage image;
  EXPECT_THROW(cameras.Render(BallOnBlock(), 0, {image.Buffers()}), core::Error);
  EXPECT_THROW(cameras.Render({}, 0, {}), core::Error);
  EXPECT_THROW(SceneCameras(asset_set, {"spoon"}, {spec}), core::Error);
  EXPECT_THROW(SceneCameras(asset_set, {"ball"}, {}), core::Error);
  spec.mount = "wrist";
  try {
    SceneCameras(asset_set, {"ball"}, {spec});
    ADD_FAILURE() << "no error";
  } catch (const core::Error& error) {
    EXPECT_STREQ(error.what(), "camera 'side': a scene has no mount 'wrist' (mount it on world)");
  }
}

}  // namespace
}  // namespace simwright::scene
