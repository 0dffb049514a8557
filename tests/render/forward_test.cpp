#include "render/forward.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/camera.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::render {
namespace {

core::TexturedMesh ForwardSquare(double side, double z) {
  core::TexturedMesh mesh;
  const double h = 0.5 * side;
  mesh.mesh.vertices = {{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}};
  mesh.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Looks down from above: image right is world +x, image down is world -y.
core::Camera ForwardFromAbove(double height, int size, double focal) {
  core::Camera camera;
  camera.width = camera.height = size;
  camera.fx = camera.fy = focal;
  camera.cx = camera.cy = 0.5 * size;
  camera.world_from_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  camera.world_from_camera.translation() = Eigen::Vector3d(0, 0, height);
  return camera;
}

TEST(Forward, DepthMaskNormalAndLabelOfASquare) {
  const core::TexturedMesh far = ForwardSquare(10.0, 0.0), near = ForwardSquare(1.0, 0.5);
  Scene scene;
  EXPECT_EQ(scene.Add(&far), 0);
  EXPECT_EQ(scene.Add(&near), 1);
  scene.Commit();
  const core::Camera camera = ForwardFromAbove(2.5, 100, 100.0);
  ForwardOptions options;
  options.samples_per_side = 4;
  const ForwardBuffers buffers = RenderForward(scene, camera, options);
  const size_t middle = buffers.Index(50, 50), edge = buffers.Index(2, 2);
  EXPECT_NEAR(buffers.depth[middle], 2.0f, 1e-5f);
  EXPECT_NEAR(buffers.depth[edge], 2.5f, 1e-5f);
  EXPECT_EQ(buffers.label[middle], 1);
  EXPECT_EQ(buffers.label[edge], 0);
  EXPECT_NEAR(buffers.normal[middle].z(), 1.0f, 1e-6f);
  // The near square is 1 m wide at 2 m: 50 pixels.
  int near_pixels = 0;
  for (const int label : buffers.label) near_pixels += label == 1;
  EXPECT_NEAR(near_pixels, 2500, 110);
}

TEST(Forward, CoverageIsTheAreaToAFractionOfAPixel) {
  const core::TexturedMesh square = ForwardSquare(1.0, 0.0);
  Scene scene;
  scene.Add(&square);
  scene.Commit();
  const core::Camera camera = ForwardFromAbove(2.0, 64, 50.3);  // 25.15 pixels wide
  ForwardOptions options;
  options.samples_per_side = 16;
  const ForwardBuffers buffers = RenderForward(scene, camera, options);
  double area = 0.0;
  for (const float m : buffers.mask) area += m;
  EXPECT_NEAR(area, 25.15 * 25.15, 0.02 * 25.15 * 25.15);
}

TEST(Forward, PacketsHitWhatSingleRaysHit) {
  const core::TexturedMesh far = ForwardSquare(3.0, 0.0), near = ForwardSquare(1.0, 0.5);
  Scene scene;
  scene.Add(&far);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.rotate(Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.3, 0.5, 0.8).normalized()));
  scene.Add(&near, turned);
  scene.Commit();
  core::Camera camera = ForwardFromAbove(2.5, 101, 60.0);
  camera.world_from_camera.translation().head<2>() << 0.0137, 0.0073;  // off the diagonals
  const ForwardBuffers buffers = RenderForward(scene, camera);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3f ray = camera.Ray({x + 0.5, y + 0.5}).cast<float>();
      const Hit hit = scene.Intersect(camera.position().cast<float>(), ray);
      const size_t at = buffers.Index(x, y);
      EXPECT_EQ(buffers.label[at], hit.instance);
      EXPECT_EQ(buffers.triangle[at], hit.triangle);
      EXPECT_NEAR(buffers.depth[at], hit.depth, 1e-6f);
    }
  }
}

void ExpectEqual(const ForwardBuffers& a, const ForwardBuffers& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.mask, b.mask);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.color.width, b.color.width);
  EXPECT_EQ(a.color.height, b.color.height);
  EXPECT_EQ(a.color.pixels, b.color.pixels);
}

TEST(Forward, BuffersOfAnotherImageAreOverwritten) {
  const core::TexturedMesh square = ForwardSquare(1.0, 0.0);
  Scene scene;
  scene.Add(&square);
  scene.Commit();
  ForwardOptions shaded, sampled;
  shaded.shaded = sampled.shaded = true;
  sampled.samples_per_side = 3;
  const core::Camera large = ForwardFromAbove(1.2, 64, 60.0), small = ForwardFromAbove(3.0, 27, 60);
  ForwardBuffers buffers;
  RenderForward(scene, large, shaded, &buffers);
  RenderForward(scene, small, {}, &buffers);
  ExpectEqual(buffers, RenderForward(scene, small));
  RenderForward(scene, large, sampled, &buffers);
  RenderForward(scene, small, sampled, &buffers);
  ExpectEqual(buffers, RenderForward(scene, small, sampled));
  const core::Image taken = std::move(buffers.color);
  RenderForward(scene, small, sampled, &buffers);
  EXPECT_EQ(buffers.color.pixels, taken.pixels);
}

TEST(Forward, MovedVerticesAreRefitted) {
  core::TexturedMesh square = ForwardSquare(1.0, 0.0);
  Scene scene;
  scene.Add(&square);
  scene.Commit();
  std::vector<Eigen::Vector3d> raised = square.mesh.vertices;
  for (Eigen::Vector3d& v : raised) v.z() += 0.7;
  scene.MoveVertices(0, raised);
  scene.Commit();
  EXPECT_NEAR(scene.Intersect({0, 0, 3}, {0, 0, -1}).depth, 2.3f, 1e-5f);
  EXPECT_TRUE(scene.Occluded({0, 0, 3}, {0, 0, -1}, 0.0f, 2.5f));
  EXPECT_FALSE(scene.Occluded({0, 0, 3}, {0, 0, -1}, 0.0f, 2.0f));
}

TEST(Forward, TextureAppearsWhereItsCoordinatesSay) {
  core::TexturedMesh square = ForwardSquare(2.0, 0.0);
  core::Image texture(2, 2, 3);
  texture.At(0, 0)[0] = 255;  // upper left red, the rest black
  square.textures.push_back(texture);
  square.materials.push_back({"t", Eigen::Vector4f::Ones(), 0});
  square.triangle_material = {0, 0};
  square.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  Scene scene;
  scene.Add(&square);
  scene.Commit();
  ForwardOptions options;
  options.shaded = true;
  options.lit = false;
  const ForwardBuffers buffers = RenderForward(scene, ForwardFromAbove(2.0, 40, 40.0), options);
  // World (-0.5, 0.5) is the texture's upper left, seen at image (10, 10).
  EXPECT_GT(buffers.color.At(10, 10)[0], 200);
  EXPECT_LT(buffers.color.At(30, 30)[0], 60);
}

TEST(Forward, ThreadsDoNotChangeThePicture) {
  const core::TexturedMesh square = ForwardSquare(1.0, 0.0);
  Scene scene;
  scene.Add(&square);
  scene.Commit();
  ForwardOptions options;
  options.shaded = true;
  options.occlusion_rays = 4;
  core::SetThreadCount(1);
  const ForwardBuffers one = RenderForward(scene, ForwardFromAbove(2.0, 50, 60.0), options);
  core::SetThreadCount(3);
  const ForwardBuffers three = RenderForward(scene, ForwardFromAbove(2.0, 50, 60.0), options);
  core::SetThreadCount(0);
  EXPECT_EQ(one.color.pixels, three.color.pixels);
  EXPECT_EQ(one.depth, three.depth);
}

// Cosine-weighted directions from a floor: an endless wall at its edge covers half of them, which
// needs all directions of a pixel to be spread evenly.
TEST(Forward, OcclusionRaysOfAPixelAreSpreadTogether) {
  core::TexturedMesh corner = ForwardSquare(1.0, 0.0);
  const int first = static_cast<int>(corner.mesh.vertices.size());
  for (const double y : {-500.0, 500.0}) {
    for (const double z : {0.0, 500.0}) corner.mesh.vertices.emplace_back(0.5, y, z);
  }
  for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(2, 1, 3)}) {
    corner.mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
  corner.triangle_material.resize(corner.mesh.triangles.size(), 0);
  corner.corner_uvs.clear();
  corner.textures.clear();
  corner.materials.assign(1, {"white", Eigen::Vector4f::Ones(), -1});
  Scene scene;
  scene.Add(&corner);
  scene.Commit();
  ForwardOptions options;
  options.shaded = true;
  options.light = SphericalHarmonicsLight::Uniform(1.0f);
  options.samples_per_side = 3;
  options.occlusion_rays = 2;
  options.occlusion_reach = 0.9f;
  const auto error_of = [&](bool per_pixel) {
    options.occlusion_per_pixel = per_pixel;
    const ForwardBuffers buffers = RenderForward(scene, ForwardFromAbove(2.0, 40, 40.0), options);
    double sum = 0.0, square = 0.0;
    int count = 0;
    for (int y = 14; y < 26; ++y) {
      for (int x = 25; x < 29; ++x, ++count) {
        const double error = LinearFromSrgb(buffers.color.At(x, y)[0] / 255.0f) - 0.5;
        sum += error;
        square += error * error;
      }
    }
    EXPECT_NEAR(sum / count, 0.0, 0.03) << per_pixel;
    return std::sqrt(square / count);
  };
  const double apart = error_of(false), together = error_of(true);
  EXPECT_LT(together, 0.05);
  EXPECT_LT(together, 0.6 * apart);
}

TEST(Light, IrradianceOfAClampedCosineLobe) {
  // Uniform radiance L gives irradiance pi L: over pi, L.
  const SphericalHarmonicsLight uniform = SphericalHarmonicsLight::Uniform(0.7f);
  EXPECT_NEAR(uniform.Shade(Eigen::Vector3f(0.6f, 0.0f, 0.8f)).x(), 0.7f, 1e-4f);
  // Radiance 1 + z integrates against the cosine lobe of normal n to pi + (2 pi / 3) n_z.
  SphericalHarmonicsLight tilted = SphericalHarmonicsLight::Uniform(1.0f);
  tilted.radiance.row(2).array() += 1.0f / 0.488603f;
  EXPECT_NEAR(tilted.Shade(Eigen::Vector3f::UnitZ()).y(), 1.0f + 2.0f / 3.0f, 1e-4f);
  EXPECT_NEAR(SrgbFromLinear(LinearFromSrgb(0.37f)), 0.37f, 1e-5f);
}

// A box's corner normals lean over its edges: on a side seen at a grazing angle they point away
// from the camera, yet belong to that side, which is lit.
TEST(Forward, NormalsStayOnTheirSideOfAFaceSeenFlatly) {
  core::TexturedMesh box;
  for (int c = 0; c < 8; ++c) {
    box.mesh.vertices.emplace_back(c & 1 ? 0.1 : -0.1, c & 2 ? 0.1 : -0.1, c & 4 ? 1.0 : 0.0);
  }
  box.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  Scene scene;
  scene.Add(&box);
  scene.Commit();
  ForwardOptions options;
  options.samples_per_side = 3;
  options.shaded = true;
  options.occlusion_rays = 8;
  int flat = 0;
  for (const double azimuth : {-0.1, -0.05, 0.05, 0.1}) {
    // From the front, past the side: the orbit starts at its azimuth.
    const core::Camera camera = core::OrbitCamera({0, 0, 0.5}, 3.0, 0.3, azimuth, 0.4, 200, 200);
    const ForwardBuffers buffers = RenderForward(scene, camera, options);
    for (size_t at = 0; at < buffers.triangle.size(); ++at) {
      if (buffers.triangle[at] < 0) continue;
      const Eigen::Vector3d area = core::TriangleAreaVector(box.mesh, buffers.triangle[at]);
      const Eigen::Vector3f face = area.normalized().cast<float>();
      ASSERT_GE(buffers.normal[at].dot(face), 0.0f) << buffers.triangle[at];
      const int x = static_cast<int>(at) % 200, y = static_cast<int>(at) / 200;
      if (buffers.mask[at] == 1.0f) {
        EXPECT_GT(buffers.color.At(x, y)[0], 40) << x << " " << y;
      }
      const Eigen::Vector3d to_eye = camera.position() - Eigen::Vector3d(0, 0, 0.5);
      flat += area.normalized().dot(to_eye.normalized()) < 0.15;
    }
  }
  EXPECT_GT(flat, 100);
}

TEST(Forward, RefusesImpossiblePictures) {
  Scene scene;
  core::Camera camera;
  EXPECT_THROW(RenderForward(scene, camera), core::Error);
  core::TexturedMesh empty;
  EXPECT_THROW(scene.Add(&empty), core::Error);
}

}  // namespace
}  // namespace simwright::render
