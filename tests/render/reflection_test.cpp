// Specular reflection: energy, the direction of highlights, normal maps, and both renderers.
#include "render/reflection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/camera.h"
#include "core/error.h"
#include "core/mesh.h"
#include "render/forward.h"
#include "render/rigid_render.h"

namespace simwright::render {
namespace {

using Eigen::Vector3f;

// A sphere of radius 0.5 m with coordinates, of one white material.
core::TexturedMesh LookedSphere(const Eigen::Vector4f& color) {
  constexpr int kRings = 48, kSectors = 96;
  core::TexturedMesh sphere;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j <= kSectors; ++j) {
      const double polar = std::numbers::pi * i / kRings;
      const double azimuth = 2.0 * std::numbers::pi * j / kSectors;
      sphere.mesh.vertices.emplace_back(0.5 * std::sin(polar) * std::cos(azimuth),
                                        0.5 * std::sin(polar) * std::sin(azimuth),
                                        0.5 * std::cos(polar));
    }
  }
  const auto add = [&](int a, int b, int c) {
    sphere.mesh.triangles.emplace_back(a, b, c);
    for (const int vertex : {a, b, c}) {
      sphere.corner_uvs.emplace_back(static_cast<float>(vertex % (kSectors + 1)) / kSectors,
                                     1.0f - static_cast<float>(vertex / (kSectors + 1)) / kRings);
    }
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const int at = i * (kSectors + 1) + j;
      if (i > 0) add(at, at + kSectors + 1, at + 1);
      if (i + 1 < kRings) add(at + 1, at + kSectors + 1, at + kSectors + 2);
    }
  }
  sphere.materials = {{"white", color, -1}};
  sphere.triangle_material.assign(sphere.mesh.triangles.size(), 0);
  return sphere;
}

core::PbrLook LookOf(float metallic, float roughness) {
  core::PbrLook look;
  look.materials.resize(1);
  look.materials[0].metallic = metallic;
  look.materials[0].roughness = roughness;
  return look;
}

// A light from one direction of irradiance 1.
SphericalHarmonicsLight DistantLight(const Vector3f& direction) {
  SphericalHarmonicsLight light;
  Eigen::Matrix<float, 9, 1> basis = IrradianceWeights(direction);
  basis.segment<3>(1) *= 1.5f;
  basis.segment<5>(4) *= 4.0f;
  light.radiance = basis * Eigen::RowVector3f::Ones();
  return light;
}

TEST(Reflection, FindsADistantLight) {
  const Vector3f direction = Vector3f(0.3f, -0.5f, 0.7f).normalized();
  const SpecularLight light(DistantLight(direction));
  EXPECT_LT((light.key_direction() - direction).norm(), 1e-5f);
}

// Nothing is reflected that did not arrive: a white mirror under uniform light.
TEST(Reflection, KeepsEnergyUnderUniformLight) {
  const SpecularLight light(SphericalHarmonicsLight::Uniform(0.8f));
  for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f}) {
    for (const float cosine : {0.1f, 0.5f, 1.0f}) {
      const Vector3f camera(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
      const float reflected =
          light.Reflect({Vector3f::Ones(), roughness}, Vector3f::UnitZ(), camera).x();
      EXPECT_LE(reflected, 0.805f);
      EXPECT_GE(reflected, 0.8f * (0.87f - 0.6f * roughness * roughness));
    }
  }
}

// The lobe of the distant light, summed over all its directions, has the albedo that the
// surroundings are reflected with.
TEST(Reflection, TheLobeHasTheAlbedoOfItsFit) {
  const SpecularLight uniform(SphericalHarmonicsLight::Uniform(1.0f));
  for (const float roughness : {0.4f, 0.6f, 0.9f}) {
    for (const float f0 : {0.04f, 0.8f}) {
      const Vector3f camera = Vector3f(0.6f, 0.0f, 0.8f);
      const Reflection reflection{Vector3f::Constant(f0), roughness};
      constexpr int kSteps = 120;
      double sum = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double z = (i + 0.5) / kSteps;  // equal areas of the hemisphere
        for (int j = 0; j < 2 * kSteps; ++j) {
          const double azimuth = std::numbers::pi * (j + 0.5) / kSteps;
          const double across = std::sqrt(1.0 - z * z);
          const Vector3f direction =
              Eigen::Vector3d(across * std::cos(azimuth), across * std::sin(azimuth), z)
                  .cast<float>();
          sum += SpecularLight(DistantLight(direction))
                     .Reflect(reflection, Vector3f::UnitZ(), camera, 0.0f)
                     .x();
        }
      }
      const double albedo = sum * 2.0 * std::numbers::pi / (2.0 * kSteps * kSteps);
      EXPECT_NEAR(albedo, uniform.Reflect(reflection, Vector3f::UnitZ(), camera).x(), 0.02)
          << roughness << " " << f0;
    }
  }
}

TEST(Reflection, HighlightsAreWhereTheNormalHalvesTheDirections) {
  const core::TexturedMesh sphere = LookedSphere({0.1f, 0.1f, 0.1f, 1.0f});
  const core::PbrLook look = LookOf(0.0f, 0.3f);
  Scene scene;
  scene.Add(&sphere, Eigen::Isometry3d::Identity(), &look);
  scene.Commit();
  const core::Camera camera = core::OrbitCamera({0, 0, 0}, 4.0, 0.3, 0.4, 0.35, 240, 240);
  const Vector3f key = Vector3f(0.9f, -0.3f, 0.8f).normalized();
  ForwardOptions options;
  options.shaded = true;
  options.light = DistantLight(key);
  const ForwardBuffers buffers = RenderForward(scene, camera, options);
  int brightest = 0;
  Vector3f sum = Vector3f::Zero();
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 240; ++x) brightest = std::max<int>(brightest, buffers.color.At(x, y)[0]);
  }
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 240; ++x) {
      if (buffers.color.At(x, y)[0] >= brightest - 4) sum += buffers.normal[buffers.Index(x, y)];
    }
  }
  const Vector3f normal = sum.normalized();
  const Vector3f to_camera = (camera.position().cast<float>() - 0.5f * normal).normalized();
  const Vector3f half = (key + to_camera).normalized();
  EXPECT_GT(brightest, 120);
  EXPECT_GT(normal.dot(half), std::cos(2.0f * std::numbers::pi_v<float> / 180.0f));
}

// A map of one tilted normal shades a square as a square tilted so.
TEST(Reflection, ANormalMapTiltsTheShading) {
  core::TexturedMesh square;
  square.mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  square.materials = {{"white", {1, 1, 1, 1}, -1}};
  square.triangle_material = {0, 0};
  core::PbrLook look = LookOf(0.0f, 1.0f);
  core::Image map(4, 4, 3);
  const Vector3f tilted = Vector3f(0.5f, -0.3f, 0.8f).normalized();
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    map.pixels[i] =
        static_cast<std::uint8_t>(std::lround(127.5f * (1.0f + tilted[static_cast<int>(i % 3)])));
  }
  look.images = {map};
  look.materials[0].normal_map = 0;
  Vector3f perturbed;
  Scene scene;
  scene.Add(&square, Eigen::Isometry3d::Identity(), &look);
  scene.Commit();
  const Hit hit = scene.Intersect({0.2f, 0.1f, 3.0f}, {0, 0, -1});
  scene.ReflectionAt(hit, Vector3f::UnitZ(), &perturbed);
  EXPECT_LT((perturbed - tilted).norm(), 0.01f);
  // From behind, the map's bumps are seen as dents: x and y stay, the side turns.
  const Hit back = scene.Intersect({0.2f, 0.1f, -3.0f}, {0, 0, 1});
  scene.ReflectionAt(back, -Vector3f::UnitZ(), &perturbed);
  EXPECT_LT((perturbed - Vector3f(tilted.x(), tilted.y(), -tilted.z())).norm(), 0.01f);
}

TEST(Reflection, BothRenderersAgree) {
  const core::TexturedMesh sphere = LookedSphere({0.9f, 0.6f, 0.3f, 1.0f});
  core::PbrLook look = LookOf(0.6f, 0.5f);
  core::Image bumps(64, 32, 3, 128);
  for (std::size_t i = 0; i < bumps.pixels.size(); ++i) {
    const std::size_t x = i / 3 % 64;
    bumps.pixels[i] = static_cast<std::uint8_t>(i % 3 == 2 ? 240 : i % 3 == 0 ? 90 + x : 128);
  }
  look.images = {bumps, core::Image(2, 2, 1, 180)};
  look.materials[0].normal_map = 0;
  look.materials[0].roughness_map = 1;
  const core::Camera camera = core::OrbitCamera({0, 0, 0}, 4.0, 0.3, 0.4, 0.35, 96, 96);
  Scene scene;
  scene.Add(&sphere, Eigen::Isometry3d::Identity(), &look);
  scene.Commit();
  ForwardOptions options;
  options.shaded = true;
  const core::Image forward = RenderForward(scene, camera, options).color;
  RigidScene rigid;
  rigid.Add(std::make_shared<RigidMesh>(sphere, look), 1);
  std::vector<std::uint8_t> rgb(96 * 96 * 3);
  ImageBuffers buffers;
  buffers.rgb = rgb.data();
  RenderRigid(rigid, camera, buffers);
  int different = 0, covered = 0;
  for (int i = 0; i < 96 * 96; ++i) {
    if (forward.pixels[static_cast<std::size_t>(4 * i + 3)] == 0) continue;
    ++covered;
    for (int c = 0; c < 3; ++c) {
      const auto at = [&](int stride) { return static_cast<std::size_t>(stride * i + c); };
      different += std::abs(forward.pixels[at(4)] - rgb[at(3)]) > 2 ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 3000);
  EXPECT_LT(different, covered / 100);
}

TEST(Reflection, RefusesALookWithoutItsMaps) {
  const core::TexturedMesh sphere = LookedSphere({1, 1, 1, 1});
  core::PbrLook look = LookOf(0.0f, 0.5f);
  look.materials[0].normal_map = 3;
  Scene scene;
  EXPECT_THROW(scene.Add(&sphere, Eigen::Isometry3d::Identity(), &look), core::Error);
  EXPECT_THROW(RigidMesh(sphere, look), core::Error);
}

}  // namespace
}  // namespace simwright::render
