#include "core/mesh.h"

#include <gtest/gtest.h>

#include "core/camera.h"
#include "core/error.h"

namespace simwright::core {
namespace {

TEST(Mesh, RefusesBadIndicesAndNumbers) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_NO_THROW(RequireValid(mesh, "m"));
  EXPECT_NEAR(SurfaceArea(mesh), 0.5, 1e-15);
  mesh.triangles.push_back({0, 1, 3});
  EXPECT_THROW(RequireValid(mesh, "m"), Error);
  mesh.triangles.pop_back();
  mesh.vertices[1].x() = std::nan("");
  EXPECT_THROW(RequireValid(mesh, "m"), Error);
}

TEST(Mesh, MirroringKeepsTheOutsideOutside) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.linear()(0, 0) = -1;
  Transform(mirror, &mesh);
  EXPECT_GT(TriangleAreaVector(mesh, 0).z(), 0.0);
}

TEST(Mesh, TextureSamplesTexelCentres) {
  Image texture(2, 2, 3);
  texture.At(0, 0)[0] = 255;  // upper left
  const Eigen::Vector4f upper_left = SampleTexture(texture, {0.25f, 0.75f});
  EXPECT_FLOAT_EQ(upper_left.x(), 1.0f);
  EXPECT_FLOAT_EQ(SampleTexture(texture, {0.25f, 0.25f}).x(), 0.0f);
  EXPECT_FLOAT_EQ(SampleTexture(texture, {0.25f, 0.5f}).x(), 0.5f);
}

TEST(Camera, ProjectsWhatItsRaysHit) {
  const Camera camera = OrbitCamera({0.1, 0.2, 0.3}, 2.0, 0.4, 1.1, 0.6, 640, 480);
  const Eigen::Vector3d center = camera.Project({0.1, 0.2, 0.3});
  EXPECT_NEAR(center.x(), 320, 1e-9);
  EXPECT_NEAR(center.y(), 240, 1e-9);
  EXPECT_NEAR(center.z(), 2.0, 1e-12);
  const Eigen::Vector2d pixel(12.5, 400.25);
  const Eigen::Vector3d point = camera.position() + 1.7 * camera.Ray(pixel);
  const Eigen::Vector3d projected = camera.Project(point);
  EXPECT_NEAR((projected.head<2>() - pixel).norm(), 0.0, 1e-9);
  EXPECT_NEAR(projected.z(), 1.7, 1e-12);
  // Up in the world is up in the image.
  EXPECT_LT(camera.Project({0.1, 0.2, 0.4}).y(), 240);
}

}  // namespace
}  // namespace simwright::core
