#include "render/camera_spec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/error.h"
#include "render/look_ranges.h"

namespace simwright::render {
namespace {

CameraSpec SideSpec() {
  CameraSpec spec;
  spec.name = "side";
  spec.mount_from_camera = LookAt({0.3, -1.0, 0.5}, {0.4, 0.1, 0.2});
  return spec;
}

TEST(CameraSpec, LooksAtItsTargetWithTheWorldUpright) {
  CameraSpec spec = SideSpec();
  spec.width = 200, spec.height = 100;
  spec.vertical_fov = 1.0;
  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  const core::Camera camera = CameraAt(spec, mount);
  const Eigen::Vector3d target(1.4, 2.1, 3.2);
  const Eigen::Vector3d image = camera.Project(target);
  EXPECT_NEAR(image.x(), 100.0, 1e-9);
  EXPECT_NEAR(image.y(), 50.0, 1e-9);
  EXPECT_NEAR(image.z(), (target - camera.position()).norm(), 1e-12);
  EXPECT_LT(camera.Project(target + Eigen::Vector3d(0, 0, 0.1)).y(), 50.0);  // up is up
  EXPECT_GT(camera.Project(target + Eigen::Vector3d(0.1, 0, 0)).x(), 100.0);
  EXPECT_NEAR(camera.world_from_camera.linear().determinant(), 1.0, 1e-12);
  // The upper edge is half the field of view above the axis.
  const Eigen::Vector3d edge = camera.Ray({100.0, 0.0}), axis = camera.Ray({100.0, 50.0});
  EXPECT_NEAR(std::acos(edge.normalized().dot(axis.normalized())), 0.5, 1e-12);
}

TEST(CameraSpec, IntrinsicsReplaceTheFieldOfView) {
  CameraSpec spec = SideSpec();
  spec.intrinsics = CameraIntrinsics{300.0, 310.0, 60.0, 70.0};
  spec.vertical_fov = 99.0;
  std::string error;
  EXPECT_TRUE(spec.IsValid(&error)) << error;
  const core::Camera camera = CameraAt(spec, Eigen::Isometry3d::Identity());
  EXPECT_EQ(camera.fx, 300.0);
  EXPECT_EQ(camera.fy, 310.0);
  EXPECT_EQ(camera.cx, 60.0);
  EXPECT_EQ(camera.cy, 70.0);
}

TEST(CameraSpec, AnInvalidOneNamesTheCameraAndTheValue) {
  const auto error_of = [](const std::function<void(CameraSpec*)>& change) {
    CameraSpec spec = SideSpec();
    change(&spec);
    std::string error;
    EXPECT_FALSE(spec.IsValid(&error));
    return error;
  };
  EXPECT_EQ(error_of([](CameraSpec* spec) { spec->width = 0; }),
            "camera 'side': width is 0 pixels, outside 1 to 8192");
  EXPECT_EQ(error_of([](CameraSpec* spec) { spec->height = 100000; }),
            "camera 'side': height is 100000 pixels, outside 1 to 8192");
  EXPECT_EQ(error_of([](CameraSpec* spec) { spec->vertical_fov = 3.5; }),
            "camera 'side': vertical_fov is 3.5 rad, outside 0.01 to 3.1");
  EXPECT_EQ(error_of([](CameraSpec* spec) {
              spec->vertical_fov = std::numeric_limits<double>::quiet_NaN();
            }),
            "camera 'side': vertical_fov is nan rad, outside 0.01 to 3.1");
  EXPECT_EQ(error_of([](CameraSpec* spec) {
              spec->intrinsics = CameraIntrinsics{-1.0, 100.0, 64.0, 64.0};
            }),
            "camera 'side': fx is -1 pixels, but must be positive");
  EXPECT_EQ(error_of([](CameraSpec* spec) { spec->mount = ""; }), "camera 'side': mount is empty");
  EXPECT_EQ(
      error_of([](CameraSpec* spec) { spec->mount_from_camera.translation().x() = INFINITY; }),
      "camera 'side': its pose is not finite");
  EXPECT_NE(error_of([](CameraSpec* spec) {
              spec->mount_from_camera.linear() *= 2.0;
            }).find("camera 'side': its rotation is not orthonormal"),
            std::string::npos);
  EXPECT_NE(error_of([](CameraSpec* spec) { spec->name = ""; }).find("needs a name"),
            std::string::npos);
  EXPECT_THROW(RequireValid({SideSpec(), SideSpec()}), core::Error);  // one name twice
  EXPECT_THROW(LookAt({0, 0, 1}, {0, 0, 0}), core::Error);            // along the up direction
}

SceneLook BaseLook() {
  SceneLook base;
  base.cameras = {SideSpec(), SideSpec()};
  base.cameras[1].intrinsics = CameraIntrinsics{100.0, 100.0, 64.0, 64.0};
  return base;
}

bool SameSurface(const SurfaceLook& a, const SurfaceLook& b) {
  return a.color == b.color && a.tint == b.tint && a.pattern == b.pattern &&
         a.pattern_color == b.pattern_color && a.pattern_size == b.pattern_size &&
         a.pattern_strength == b.pattern_strength && a.pattern_seed == b.pattern_seed;
}

bool SameLook(const SceneLook& a, const SceneLook& b) {
  bool same = SameSurface(a.robot, b.robot) && SameSurface(a.gripper, b.gripper) &&
              SameSurface(a.backdrop.floor_look, b.backdrop.floor_look) &&
              SameSurface(a.backdrop.wall_look, b.backdrop.wall_look) &&
              a.backdrop.walls == b.backdrop.walls &&
              a.backdrop.background == b.backdrop.background &&
              a.light.ambient.radiance == b.light.ambient.radiance &&
              a.light.shadow == b.light.shadow && a.objects.size() == b.objects.size();
  for (std::size_t i = 0; same && i < a.objects.size(); ++i) {
    same = SameSurface(a.objects[i], b.objects[i]);
  }
  for (std::size_t i = 0; same && i < a.cameras.size(); ++i) {
    same = a.cameras[i].mount_from_camera.isApprox(b.cameras[i].mount_from_camera, 0.0) &&
           a.cameras[i].vertical_fov == b.cameras[i].vertical_fov;
  }
  return same;
}

TEST(LookRanges, AreOffByDefault) {
  const SceneLook base = BaseLook();
  SceneLook expected = base;
  expected.objects.resize(3);
  for (const std::uint64_t seed : {0, 1, 12345}) {
    EXPECT_TRUE(SameLook(SampleLook({}, base, 3, seed), expected)) << seed;
  }
}

TEST(LookRanges, ALookIsAFunctionOfItsSeed) {
  const LookRanges wide = LookRanges::Wide();
  std::string error;
  ASSERT_TRUE(wide.IsValid(&error)) << error;
  const SceneLook base = BaseLook(), one = SampleLook(wide, base, 2, 7);
  EXPECT_TRUE(SameLook(one, SampleLook(wide, base, 2, 7)));
  EXPECT_FALSE(SameLook(one, SampleLook(wide, base, 2, 8)));
  // An object more, or another range, leaves the rest as it is.
  SceneLook more = SampleLook(wide, base, 3, 7);
  more.objects.pop_back();
  EXPECT_TRUE(SameLook(one, more));
  LookRanges without_floor = wide;
  without_floor.floor_color = without_floor.floor_pattern = 0.0;
  SceneLook plain = SampleLook(without_floor, base, 2, 7);
  EXPECT_TRUE(SameSurface(plain.backdrop.floor_look, SurfaceLook()));
  plain.backdrop.floor_look = one.backdrop.floor_look;
  EXPECT_TRUE(SameLook(one, plain));
}

TEST(LookRanges, SamplesStayWithinTheirRanges) {
  LookRanges ranges;
  ranges.object_color = 0.5;
  ranges.camera_position = 0.03;
  ranges.camera_angle = 0.1;
  ranges.camera_fov = 0.2;
  ranges.light_strength = {0.5, 2.0};
  ranges.shadow = {0.2, 0.4};
  const SceneLook base = BaseLook();
  int colored = 0;
  double farthest = 0.0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const SceneLook look = SampleLook(ranges, base, 1, seed);
    colored += look.objects[0].color.has_value();
    EXPECT_GE(look.light.shadow, 0.2f);
    EXPECT_LE(look.light.shadow, 0.4f);
    const float strength = look.light.ambient.radiance(0, 0) / base.light.ambient.radiance(0, 0);
    EXPECT_GE(strength, 0.5f - 1e-5f);
    EXPECT_LE(strength, 2.0f + 1e-5f);
    const Eigen::Isometry3d change =
        base.cameras[0].mount_from_camera.inverse() * look.cameras[0].mount_from_camera;
    EXPECT_LE(change.translation().cwiseAbs().maxCoeff(), 0.03 + 1e-12);
    farthest = std::max(farthest, change.translation().cwiseAbs().maxCoeff());
    EXPECT_LE(Eigen::AngleAxisd(change.linear()).angle(), 0.1 * std::sqrt(3.0) + 1e-9);
    EXPECT_NEAR(look.cameras[1].intrinsics->fx, 100.0, 20.0 + 1e-9);
    std::string error;
    EXPECT_TRUE(look.cameras[0].IsValid(&error)) << error;
  }
  EXPECT_NEAR(colored, 200, 40);  // four standard deviations
  EXPECT_GT(farthest, 0.029);
}

TEST(LookRanges, AnInvalidOneNamesTheValue) {
  const auto error_of = [](const std::function<void(LookRanges*)>& change) {
    LookRanges ranges;
    change(&ranges);
    std::string error;
    EXPECT_FALSE(ranges.IsValid(&error));
    return error;
  };
  EXPECT_EQ(error_of([](LookRanges* r) { r->walls = 1.5; }),
            "walls is 1.5, but must be from 0 to 1");
  EXPECT_EQ(error_of([](LookRanges* r) { r->tint = -0.1; }),
            "tint is -0.1, but must be from 0 to 0.9");
  EXPECT_EQ(error_of([](LookRanges* r) {
              r->light_strength = {2.0, 1.0};
            }),
            "light_strength.high is 1, but must be at least light_strength.low, at most 10");
  EXPECT_EQ(error_of([](LookRanges* r) { r->camera_angle = NAN; }),
            "camera_angle is nan, but must be from 0 to pi (rad)");
  EXPECT_EQ(error_of([](LookRanges* r) {
              r->shadow = {0.5, 0.2};
            }),
            "shadow.high is 0.2, but must be at least shadow.low");
}

}  // namespace
}  // namespace simwright::render
