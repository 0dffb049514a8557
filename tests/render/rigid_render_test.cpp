// The packet renderer against closed forms, against RenderForward, and against itself.
#include "render/rigid_render.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "render/forward.h"
#include "tests/render/rigid_scene_fixture.h"

namespace simwright::render {
namespace {

core::Camera SideView(int width, int height) {
  return core::OrbitCamera({0.1, -0.05, 0.2}, 2.2, 0.5, 0.9, 0.7, width, height);
}

std::shared_ptr<const RigidMesh> Prepared(const core::TexturedMesh& mesh) {
  return std::make_shared<RigidMesh>(mesh);
}

// Returns a scene of boxes, a sphere and a textured square, without a backdrop.
RigidScene MixedScene() {
  RigidScene scene;
  const auto box = Prepared(PaintedBox({0.3, 0.2, 0.5}));
  scene.Add(box, 0, TurnedPose(0.2, 0.1, 0.3, 0.8));
  scene.Add(box, 1, TurnedPose(-0.4, 0.2, 0.2, -1.3));
  scene.Add(Prepared(FineSphere(0.2, 40)), 2, TurnedPose(0.1, -0.5, 0.3, 0.2));
  scene.Add(Prepared(TexturedSquare(2.0)), 3, TurnedPose(0.0, 0.0, 0.0, 0.1));
  return scene;
}

TEST(RigidRender, DepthAndNormalsOfASphereInClosedForm) {
  constexpr double kRadius = 0.4;
  constexpr int kRings = 120;
  const Eigen::Isometry3d pose = TurnedPose(0.1, -0.1, 0.25, 1.1);
  RigidScene scene;
  scene.Add(Prepared(FineSphere(kRadius, kRings)), 5, pose);
  const core::Camera camera = SideView(96, 80);
  const RenderedImage image = Rendered(scene, camera);
  int hits = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t i = image.Index(x, y);
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5});
      const Eigen::Vector3d from = camera.position() - pose.translation();
      const double a = ray.squaredNorm(), b = ray.dot(from),
                   c = from.squaredNorm() - kRadius * kRadius;
      const double root = b * b - a * c;
      // Near the outline the polyhedron inside the sphere is missed.
      if (std::abs(root) < 2e-3 * a) continue;
      ASSERT_EQ(image.label[i], root > 0.0 ? 5 : -1);
      if (root < 0.0) {
        EXPECT_EQ(image.depth[i], 0.0f);
        EXPECT_EQ(image.Normal(i).norm(), 0.0f);
        continue;
      }
      ++hits;
      const double depth = (-b - std::sqrt(root)) / a;
      // The largest distance from the sphere to its facets, seen at up to 80 degrees.
      EXPECT_NEAR(image.depth[i], depth, 8.0 * kRadius * (1.0 - std::cos(M_PI / kRings)));
      const Eigen::Vector3d normal = (from + depth * ray).normalized();
      EXPECT_GT(image.Normal(i).cast<double>().dot(normal), std::cos(0.03));
      EXPECT_NEAR(image.Normal(i).norm(), 1.0f, 1e-5f);
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(RigidRender, DepthAndNormalsOfABoxInClosedForm) {
  const Eigen::Vector3d half(0.2, 0.35, 0.15);
  const Eigen::Isometry3d pose = TurnedPose(0.05, 0.0, 0.2, -0.7);
  RigidScene scene;
  scene.Add(Prepared(PaintedBox(2.0 * half)), 3, pose);
  const core::Camera camera = SideView(101, 67);
  const RenderedImage image = Rendered(scene, camera);
  int hits = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Isometry3d inverse = pose.inverse();
      const Eigen::Vector3d from = inverse * camera.position();
      const Eigen::Vector3d ray = inverse.linear() * camera.Ray({x + 0.5, y + 0.5});
      // The slab method.
      double enter = 0.0, leave = 1e9;
      int side = -1;
      for (int axis = 0; axis < 3; ++axis) {
        const double near = (-std::copysign(half[axis], ray[axis]) - from[axis]) / ray[axis];
        const double far = (std::copysign(half[axis], ray[axis]) - from[axis]) / ray[axis];
        if (near > enter) enter = near, side = axis;
        leave = std::min(leave, far);
      }
      if (std::abs(leave - enter) < 1e-3) continue;  // at an edge
      const std::size_t i = image.Index(x, y);
      ASSERT_EQ(image.label[i], leave > enter ? 3 : -1);
      if (leave < enter) continue;
      ++hits;
      EXPECT_NEAR(image.depth[i], enter, 2e-5);
      Eigen::Vector3d local = Eigen::Vector3d::Zero();
      local[side] = -std::copysign(1.0, ray[side]);
      EXPECT_LT((image.Normal(i).cast<double>() - pose.linear() * local).norm(), 1e-5);
    }
  }
  EXPECT_GT(hits, 400);
}

// The share of pixels at outlines, where rays that differ by rounding may hit another part.
constexpr double kOutlines = 0.003;

TEST(RigidRender, AgreesWithRenderForward) {
  const RigidScene rigid = MixedScene();
  const core::TexturedMesh box = PaintedBox({0.3, 0.2, 0.5}), ball = FineSphere(0.2, 40),
                           square = TexturedSquare(2.0);
  Scene scene;
  const core::TexturedMesh* meshes[] = {&box, &box, &ball, &square};
  for (int p = 0; p < 4; ++p) scene.Add(meshes[p], rigid.part(p).world_from_part);
  scene.Commit();
  const core::Camera camera = SideView(160, 120);
  for (const int samples : {1, 3}) {
    ForwardOptions options;
    options.shaded = true;
    options.samples_per_side = samples;
    const ForwardBuffers forward = RenderForward(scene, camera, options);
    RigidRenderOptions packets;
    packets.samples_per_side = samples;
    const RenderedImage image = Rendered(rigid, camera, packets);
    int other = 0, colors = 0;
    for (std::size_t i = 0; i < image.Pixels(); ++i) {
      if (image.label[i] != forward.label[i]) {
        ++other;
        continue;
      }
      EXPECT_NEAR(image.depth[i], forward.depth[i], 2e-5);
      if (image.label[i] < 0) continue;
      if ((image.Normal(i) - forward.normal[i]).norm() > 1e-4) ++other;
      if (forward.mask[i] < 1.0f) continue;  // its colour has no background
      for (std::size_t c = 0; c < 3; ++c) {
        const int difference = image.rgb[3 * i + c] - forward.color.pixels[4 * i + c];
        if (std::abs(difference) > 1) ++colors;
      }
    }
    EXPECT_LT(other, kOutlines * static_cast<double>(image.Pixels()));
    EXPECT_LT(colors, kOutlines * static_cast<double>(image.Pixels()));
  }
}

TEST(RigidRender, MovedPartsEqualAFreshScene) {
  RigidScene moved = MixedScene();
  const core::Camera camera = SideView(90, 70);
  const RenderedImage before = Rendered(moved, camera);
  moved.SetPose(0, TurnedPose(-0.1, -0.3, 0.5, 2.0));
  moved.SetPose(2, TurnedPose(0.3, 0.3, 0.3, -0.4));
  RigidScene fresh;
  for (int p = 0; p < moved.size(); ++p) {
    fresh.Add(moved.part(p).mesh, moved.part(p).label, moved.part(p).world_from_part);
  }
  const RenderedImage after = Rendered(moved, camera);
  EXPECT_EQ(after, Rendered(fresh, camera));
  EXPECT_NE(after, before);
}

TEST(RigidRender, BytesDoNotDependOnThreadsBatchesOrBuffers) {
  RigidScene scene = MixedScene();
  scene.backdrop = Backdrop();
  scene.backdrop->floor_look.pattern = Pattern::kNoise;
  scene.light.shadow = 0.5f;
  const core::Camera camera = SideView(83, 61), other = SideView(40, 52);
  RigidRenderOptions options;
  options.samples_per_side = 2;
  const int threads = core::ThreadCount();
  core::SetThreadCount(1);
  const RenderedImage one = Rendered(scene, camera, options);
  core::SetThreadCount(2);
  EXPECT_EQ(one, Rendered(scene, camera, options));
  RenderedImage first(camera), second(other), third(camera);
  RenderRigidBatch({{&scene, camera, first.Buffers()},
                    {&scene, other, second.Buffers()},
                    {&scene, camera, third.Buffers()}},
                   options);
  core::SetThreadCount(threads);
  EXPECT_EQ(first, one);
  EXPECT_EQ(third, one);
  EXPECT_EQ(second, Rendered(scene, other, options));
  RenderedImage parts(camera);
  const ImageBuffers all = parts.Buffers();
  RenderRigid(scene, camera, {all.rgb, nullptr, nullptr, nullptr}, options);
  RenderRigid(scene, camera, {nullptr, all.depth, nullptr, nullptr}, options);
  RenderRigid(scene, camera, {nullptr, nullptr, all.label, nullptr}, options);
  RenderRigid(scene, camera, {nullptr, nullptr, nullptr, all.normal}, options);
  EXPECT_EQ(parts, one);
}

TEST(RigidRender, FloorAndWallsInClosedForm) {
  RigidScene scene;
  scene.backdrop = Backdrop();
  scene.backdrop->floor_height = -0.1f;
  scene.backdrop->floor_radius = 50.0f;
  scene.backdrop->walls = true;
  scene.backdrop->wall_range = {Eigen::Vector2f(-2.5f, -3.0f), Eigen::Vector2f(3.0f, 2.0f)};
  scene.backdrop->wall_height = 1.5f;
  scene.backdrop->label = 9;
  const core::Camera camera = core::OrbitCamera({0, 0, 0.3}, 1.5, 0.1, 0.4, 1.3, 64, 64);
  const RenderedImage image = Rendered(scene, camera);
  int floor = 0, wall = 0, nothing = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5}), from = camera.position();
      const double tx = ((ray.x() > 0 ? 3.0 : -2.5) - from.x()) / ray.x();
      const double ty = ((ray.y() > 0 ? 2.0 : -3.0) - from.y()) / ray.y();
      const double tz = ray.z() < 0 ? (-0.1 - from.z()) / ray.z() : 1e9;
      const double t = std::min({tx, ty, tz}), z = (from + t * ray).z();
      const std::size_t i = image.Index(x, y);
      if (std::abs(z - 1.4) < 1e-3) continue;
      if (z > 1.4) {
        ++nothing;
        EXPECT_EQ(image.label[i], -1);
        EXPECT_EQ(image.depth[i], 0.0f);
        continue;
      }
      EXPECT_EQ(image.label[i], 9);
      EXPECT_NEAR(image.depth[i], t, 1e-4);
      const Eigen::Vector3f normal = image.Normal(i);
      EXPECT_LT(normal.dot(ray.cast<float>()), 0.0f);
      EXPECT_EQ(normal.cwiseAbs().maxCoeff(), 1.0f);
      EXPECT_EQ(normal.z() == 1.0f, t == tz);
      ++(t == tz ? floor : wall);
    }
  }
  EXPECT_GT(floor, 500);
  EXPECT_GT(wall, 500);
  EXPECT_GT(nothing, 100);
}

TEST(RigidRender, AHardShadowIsTheProjectionOfItsObject) {
  RigidScene scene;
  scene.Add(Prepared(PaintedBox({0.4, 0.4, 0.02})), 1, TurnedPose(0.0, 0.0, 0.5, 0.0));
  scene.backdrop = Backdrop();
  scene.light.shadow_direction = Eigen::Vector3f(0.6f, 0.0f, 0.8f);
  core::Camera camera = SideView(120, 120);
  camera.world_from_camera = Eigen::Isometry3d::Identity();
  camera.world_from_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  camera.world_from_camera.translation() = Eigen::Vector3d(-0.4, 0.0, 2.0);
  const RenderedImage plain = Rendered(scene, camera);
  scene.light.shadow = 0.5f;
  const RenderedImage shaded = Rendered(scene, camera);
  int dark = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) {
      const std::size_t i = plain.Index(x, y);
      if (plain.label[i] != 0) continue;
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5});
      const Eigen::Vector3d point = camera.position() + camera.position().z() * ray;
      // Towards the light the ray passes z = 0.49 .. 0.51, 0.6 / 0.8 of that height further in x.
      const double low = point.x() + 0.75 * 0.49, high = point.x() + 0.75 * 0.51;
      const double beyond = std::max(std::max(low - 0.2, -0.2 - high), std::abs(point.y()) - 0.2);
      if (std::abs(beyond) < 0.006) continue;
      const double share = shaded.rgb[3 * i] / static_cast<double>(plain.rgb[3 * i]);
      EXPECT_GE(share, beyond > 0.0 ? 1.0 : 0.0);
      EXPECT_LE(share, beyond > 0.0 ? 1.0 : 0.8);
      dark += beyond < 0.0;
    }
  }
  EXPECT_GT(dark, 200);
}

TEST(RigidRender, LooksChangeColorsAndNothingElse) {
  RigidScene scene = MixedScene();
  const core::Camera camera = SideView(100, 100);
  const RenderedImage before = Rendered(scene, camera);
  SurfaceLook red, dim;
  red.color = Eigen::Vector3f(1.0f, 0.0f, 0.0f);
  dim.color = Eigen::Vector3f(1.0f, 0.0f, 0.0f);  // without effect on a texture
  dim.tint = Eigen::Vector3f(1.0f, 0.0f, 1.0f);
  scene.SetLook(0, red);
  scene.SetLook(3, dim);
  const RenderedImage after = Rendered(scene, camera);
  EXPECT_EQ(before.depth, after.depth);
  EXPECT_EQ(before.label, after.label);
  EXPECT_EQ(before.normal, after.normal);
  for (std::size_t i = 0; i < before.Pixels(); ++i) {
    const std::uint8_t *old = &before.rgb[3 * i], *now = &after.rgb[3 * i];
    if (before.label[i] == 0) {
      EXPECT_GT(now[0], 20);
      EXPECT_EQ(now[1] + now[2], 0);
    } else if (before.label[i] == 3) {
      EXPECT_EQ(now[0], old[0]);
      EXPECT_EQ(now[1], 0);
      EXPECT_EQ(now[2], old[2]);
    } else {
      EXPECT_TRUE(std::equal(old, old + 3, now));
    }
  }
}

TEST(RigidRender, ACameraInsideAPartSeesIt) {
  RigidScene scene;
  scene.Add(Prepared(PaintedBox({2.0, 2.0, 2.0})), 4);
  core::Camera camera = SideView(32, 32);
  camera.world_from_camera.translation().setZero();
  const RenderedImage image = Rendered(scene, camera);
  for (const std::int32_t label : image.label) EXPECT_EQ(label, 4);
}

TEST(RigidRender, BadInputIsRefused) {
  RigidScene scene;
  EXPECT_THROW(scene.Add(nullptr, 0), core::Error);
  EXPECT_THROW(scene.Add(Prepared(PaintedBox({1, 1, 1})), -1), core::Error);
  const core::TexturedMesh empty;
  EXPECT_THROW(RigidMesh{empty}, core::Error);
  core::Camera camera = SideView(10, 10);
  camera.width = 0;
  EXPECT_THROW(RenderRigid(scene, camera, {}), core::Error);
  EXPECT_THROW(RenderRigid(scene, SideView(10, 10), {}, {.samples_per_side = 0}), core::Error);
}

}  // namespace
}  // namespace simwright::render
