#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/texture/atlas_quality.h"
#include "tests/texture/ball.h"
#include "texture/bake.h"
#include "texture/photo_projection.h"
#include "texture/uv_atlas.h"

namespace simwright::texture {
namespace {

TEST(UvAtlas, NoTwoTrianglesShareATexel) {
  const core::TriangleMesh ball = Ball(16);
  AtlasOptions options;
  options.size = 512;
  const auto uvs = UnwrapToAtlas(ball, options);
  ASSERT_EQ(uvs.size(), 3 * ball.triangles.size());
  std::vector<int> owner(512 * 512, -1);
  int shared = 0, covered = 0;
  for (size_t t = 0; t < ball.triangles.size(); ++t) {
    const Eigen::Vector2f a = uvs[3 * t] * 512, b = uvs[3 * t + 1] * 512, c = uvs[3 * t + 2] * 512;
    EXPECT_GE(a.minCoeff(), 0.0f);
    EXPECT_LE(a.maxCoeff(), 512.0f);
    for (int y = 0; y < 512; ++y) {
      for (int x = 0; x < 512; ++x) {
        const Eigen::Vector2f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        if (p.x() < std::min({a.x(), b.x(), c.x()}) || p.x() > std::max({a.x(), b.x(), c.x()}) ||
            p.y() < std::min({a.y(), b.y(), c.y()}) || p.y() > std::max({a.y(), b.y(), c.y()})) {
          continue;
        }
        const auto side = [&](const Eigen::Vector2f& m, const Eigen::Vector2f& n) {
          return (n - m).x() * (p - m).y() - (n - m).y() * (p - m).x();
        };
        // Strictly inside: edges may be shared.
        if (side(a, b) <= 1e-3f || side(b, c) <= 1e-3f || side(c, a) <= 1e-3f) continue;
        ++covered;
        int& at = owner[static_cast<size_t>(y * 512 + x)];
        shared += at >= 0;
        at = static_cast<int>(t);
      }
    }
  }
  EXPECT_EQ(shared, 0);
  EXPECT_GT(covered, 512 * 512 / 4);
}

// Returns `count` tetrahedra in a row, of 1 to 2 cm.
core::TriangleMesh Tetrahedra(int count) {
  core::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double x = 0.03 * i, size = 0.01 + 0.01 * (i % 7) / 7.0;
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(x, 0, 0);
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(Eigen::Vector3d(x, 0, 0) + size * Eigen::Vector3d::Unit(k));
    }
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 2, 1), Eigen::Vector3i(0, 1, 3),
                                     Eigen::Vector3i(0, 3, 2), Eigen::Vector3i(1, 2, 3)}) {
      mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
    }
  }
  return mesh;
}

TEST(UvAtlas, KeepsMarginsAndOrientation) {
  for (const core::TriangleMesh& mesh : {Ball(16), Tetrahedra(40)}) {
    for (const int padding : {1, 2, 4}) {
      AtlasOptions options;
      options.size = 512;
      options.padding = padding;
      const auto uvs = UnwrapToAtlas(mesh, options);
      const auto quality = atlas_quality::MeasureAtlas(mesh, uvs, options.size, padding);
      EXPECT_EQ(quality.shared_texels, 0);
      EXPECT_GE(quality.nearest_charts, 2 * padding);
      EXPECT_EQ(quality.outside, 0);
      EXPECT_EQ(quality.reversed, 0);
      EXPECT_GT(quality.covered, 0.25);
      EXPECT_LT(quality.stretch, 1.25);
      // The texture's edge is a margin, too: lookups wrap around it.
      for (const Eigen::Vector2f& uv : uvs) {
        EXPECT_GE(uv.minCoeff() * 512, padding);
        EXPECT_LE(uv.maxCoeff() * 512, 512 - padding);
      }
    }
  }
}

TEST(UvAtlas, GivesTheSameBytesAgainAtAnyScale) {
  core::TriangleMesh ball = Ball(12);
  const auto uvs = UnwrapToAtlas(ball);
  EXPECT_TRUE(uvs == UnwrapToAtlas(ball));
  for (Eigen::Vector3d& v : ball.vertices) v *= 0x1p-20;  // a power of two: no rounding
  EXPECT_TRUE(uvs == UnwrapToAtlas(ball));
}

// A repeated vertex, collinear corners and coinciding vertices.
TEST(UvAtlas, PlacesTrianglesWithoutArea) {
  core::TriangleMesh mesh = Ball(8);
  const int last = static_cast<int>(mesh.vertices.size());
  for (const double x : {3.0, 4.0, 5.0}) mesh.vertices.emplace_back(x, 0, 0);
  mesh.triangles.emplace_back(0, 0, 1);
  mesh.triangles.emplace_back(last, last + 1, last + 2);
  mesh.triangles.emplace_back(1, 1, 1);
  const auto uvs = UnwrapToAtlas(mesh);
  ASSERT_EQ(uvs.size(), 3 * mesh.triangles.size());
  EXPECT_EQ(atlas_quality::MeasureAtlas(mesh, uvs, 1024, 2).outside, 0);
  core::TriangleMesh flat;
  flat.vertices.assign(3, Eigen::Vector3d(1, 2, 3));
  flat.triangles.emplace_back(0, 1, 2);
  for (const Eigen::Vector2f& uv : UnwrapToAtlas(flat)) {
    EXPECT_TRUE(uv.allFinite() && uv.minCoeff() >= 0.0f && uv.maxCoeff() <= 1.0f);
  }
}

TEST(UvAtlas, RefusesMorePiecesThanTexels) {
  AtlasOptions options;
  options.size = 16;
  EXPECT_THROW(UnwrapToAtlas(Tetrahedra(300), options), core::Error);
  EXPECT_THROW(UnwrapToAtlas({}), core::Error);
}

TEST(Bake, EachPointOfTheSurfaceFindsItsOwnColour) {
  const core::TriangleMesh ball = Ball(24);
  const auto uvs = UnwrapToAtlas(ball);
  const core::Image texture = BakeTexture(ball, uvs, 1024, 4, [](const SurfacePoint& p) {
    return Eigen::Vector3f((0.5 * (p.position + Eigen::Vector3d::Ones())).cast<float>());
  });
  double worst = 0.0;
  for (size_t t = 0; t < ball.triangles.size(); ++t) {
    const Eigen::Vector2f uv = (uvs[3 * t] + uvs[3 * t + 1] + uvs[3 * t + 2]) / 3.0f;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) p += ball.vertices[ball.triangles[t][k]] / 3.0;
    const Eigen::Vector3f color = core::SampleTexture(texture, uv).head<3>();
    worst = std::max<double>(
        worst, (color.cast<double>() - 0.5 * (p + Eigen::Vector3d::Ones())).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 0.02);
}

TEST(PhotoProjection, FrontTakesThePhotoAndTheBackMirrorsIt) {
  const core::TriangleMesh ball = Ball(32);
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 8.0, 0.0, -M_PI / 2, 0.4, 200, 200);
  // Left half red, right half blue.
  core::Image photo(200, 200, 3), alpha(200, 200, 1, 255);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) photo.At(x, y)[x < 100 ? 0 : 2] = 255;
  }
  const Eigen::Hyperplane<double, 3> mirror(Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero());
  const core::TexturedMesh textured = ProjectPhoto(ball, camera, photo, alpha, mirror);
  const auto color_at = [&](const Eigen::Vector3d& p) {
    size_t best = 0;
    double nearest = 1e9;
    for (size_t t = 0; t < ball.triangles.size(); ++t) {
      Eigen::Vector3d c = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) c += ball.vertices[ball.triangles[t][k]] / 3.0;
      if ((c - p).norm() < nearest) {
        nearest = (c - p).norm();
        best = t;
      }
    }
    const auto& uvs = textured.corner_uvs;
    const Eigen::Vector2f uv = (uvs[3 * best] + uvs[3 * best + 1] + uvs[3 * best + 2]) / 3.0f;
    return Eigen::Vector3f(core::SampleTexture(textured.textures[0], uv).head<3>());
  };
  for (const double y : {-0.8, 0.8}) {  // the camera's side and the far one
    EXPECT_GT(color_at({-0.6, y, 0}).x(), 0.9f) << y;
    EXPECT_GT(color_at({0.6, y, 0}).z(), 0.9f) << y;
  }
  // Never white, never the unseen grey.
  for (size_t i = 0; i < textured.textures[0].pixels.size(); i += 3) {
    EXPECT_LT(textured.textures[0].pixels[i + 1], 40);
  }
}

// Returns the texture's colour at the centroid of the face nearest to `p`.
Eigen::Vector3f ColorNear(const core::TexturedMesh& textured, const Eigen::Vector3d& p) {
  size_t best = 0;
  double nearest = 1e9;
  for (size_t t = 0; t < textured.mesh.triangles.size(); ++t) {
    Eigen::Vector3d c = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) c += textured.mesh.vertices[textured.mesh.triangles[t][k]] / 3.0;
    if ((c - p).norm() < nearest) {
      nearest = (c - p).norm();
      best = t;
    }
  }
  const auto& uvs = textured.corner_uvs;
  const Eigen::Vector2f uv = (uvs[3 * best] + uvs[3 * best + 1] + uvs[3 * best + 2]) / 3.0f;
  return core::SampleTexture(textured.textures[0], uv).head<3>();
}

TEST(PhotoProjection, EachPhotoColoursItsSideAndTheRestIsAsTold) {
  const core::TriangleMesh ball = Ball(32);
  std::vector<PhotoView> views;
  for (const double azimuth : {-M_PI / 2, 0.0}) {  // from -y a red photo, from +x a green one
    core::Image photo(120, 120, 3);
    for (size_t i = views.size(); i < photo.pixels.size(); i += 3) photo.pixels[i] = 255;
    views.push_back({core::OrbitCamera(Eigen::Vector3d::Zero(), 8.0, 0.0, azimuth, 0.4, 120, 120),
                     photo, core::Image(120, 120, 1, 255)});
  }
  const std::vector<Eigen::Vector3f> blue(ball.vertices.size(), Eigen::Vector3f::UnitZ());
  const core::TexturedMesh textured = ProjectPhotos(ball, views, blue);
  EXPECT_LT((ColorNear(textured, {-0.5, -0.8, 0}) - Eigen::Vector3f::UnitX()).norm(), 0.05f);
  EXPECT_LT((ColorNear(textured, {0.8, 0.5, 0}) - Eigen::Vector3f::UnitY()).norm(), 0.05f);
  EXPECT_LT((ColorNear(textured, {-0.7, 0.7, 0}) - Eigen::Vector3f::UnitZ()).norm(), 0.05f);
  const Eigen::Vector3f between = ColorNear(textured, {0.7, -0.7, 0});
  EXPECT_NEAR(between.x(), 0.5f, 0.15f);  // both face it equally
  EXPECT_NEAR(between.y(), 0.5f, 0.15f);
  EXPECT_THROW(ProjectPhotos(ball, {}, blue), core::Error);
  EXPECT_THROW(ProjectPhotos(ball, views, {}), core::Error);
}

TEST(PhotoProjection, RefusesSizesThatDoNotFit) {
  const core::TriangleMesh ball = Ball(8);
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 8.0, 0.0, 0.0, 0.4, 20, 20);
  const Eigen::Hyperplane<double, 3> mirror(Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero());
  EXPECT_THROW(ProjectPhoto(ball, camera, core::Image(20, 20, 3), core::Image(10, 20, 1), mirror),
               core::Error);
}

}  // namespace
}  // namespace simwright::texture
