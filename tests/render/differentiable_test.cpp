#include "render/differentiable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/render/gate_scenes.h"

namespace simwright::render {
namespace {

// A square of side 2 h at height z, seen straight from above by DifferentiableFromAbove.
DifferentiableObject DifferentiableSquare(double h, double z) {
  DifferentiableObject square;
  square.mesh.vertices = {{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return square;
}

core::Camera DifferentiableFromAbove(double height, int size, double focal) {
  core::Camera camera;
  camera.width = camera.height = size;
  camera.fx = camera.fy = focal;
  camera.cx = camera.cy = 0.5 * size;
  camera.world_from_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  camera.world_from_camera.translation() = Eigen::Vector3d(0, 0, height);
  return camera;
}

DifferentiableBuffers Constant(const core::Camera& camera, float color, float mask, float depth) {
  DifferentiableBuffers images;
  images.color = core::FloatImage(camera.width, camera.height, 3, color);
  images.mask = core::FloatImage(camera.width, camera.height, 1, mask);
  images.depth = core::FloatImage(camera.width, camera.height, 1, depth);
  return images;
}

TEST(Differentiable, ValuesOfASquare) {
  const core::Camera camera = DifferentiableFromAbove(2.0, 40, 20.0);
  DifferentiableObject square = DifferentiableSquare(1.0, 0.0);
  square.base_color = {0.2f, 0.4f, 0.6f};
  DifferentiableOptions options;
  options.render_normals = true;
  DifferentiableRenderer renderer({square}, options);
  const DifferentiableBuffers& picture = renderer.Render(camera, 1);
  // 10 pixels per metre: the square covers 20 x 20 pixels around the centre.
  EXPECT_EQ(*picture.mask.At(20, 20), 1.0f);
  EXPECT_EQ(*picture.mask.At(5, 20), 0.0f);
  EXPECT_NEAR(*picture.depth.At(20, 20), 2.0f, 1e-6f);
  EXPECT_NEAR(picture.color.At(20, 20)[2], 0.6f, 1e-6f);
  EXPECT_EQ(picture.color.At(5, 20)[2], 0.0f);
  EXPECT_NEAR(picture.normal.At(20, 20)[2], 1.0f, 1e-6f);
  double area = 0.0;
  for (const float m : picture.mask.values) area += m;
  EXPECT_NEAR(area, 400.0, 1e-3);
}

// The covered area is (2 h f / z)^2 pixels: its derivatives are known exactly.
TEST(Differentiable, TheAreaOfASquareGrowsAsItsFormulaSays) {
  const double h = 1.0, z = 2.0, f = 20.0;
  const core::Camera camera = DifferentiableFromAbove(z, 40, f);
  DifferentiableRenderer renderer({DifferentiableSquare(h, 0.0)});
  renderer.Render(camera, 3);
  SceneGradients gradients;
  renderer.Backward(Constant(camera, 0.0f, 1.0f, 0.0f), &gradients);
  const double area = std::pow(2.0 * h * f / z, 2.0);
  EXPECT_NEAR(gradients.camera.fx + gradients.camera.fy, 2.0 * area / f, 0.01 * area / f);
  EXPECT_NEAR(gradients.camera.pose.translation.z(), -2.0 * area / z, 0.01 * area / z);
  EXPECT_NEAR(gradients.objects[0].pose.translation.z(), 2.0 * area / z, 0.01 * area / z);
  double outward = 0.0;  // d(area)/dh, by vertices
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d at = renderer.object(0).mesh.vertices[i];
    outward += gradients.objects[0].vertices[i].dot(at) / h;
  }
  EXPECT_NEAR(outward, 2.0 * area / h, 0.01 * area / h);
  EXPECT_NEAR(gradients.objects[0].pose.translation.x(), 0.0, 0.01 * area);
}

// The mean depth of a tilted plane that fills the image: interior derivatives only.
TEST(Differentiable, DepthOfAPlaneThatFillsThePicture) {
  const core::Camera camera = DifferentiableFromAbove(2.0, 16, 32.0);
  DifferentiableOptions options;
  options.samples_per_side = 8;
  DifferentiableRenderer renderer({DifferentiableSquare(4.0, 0.0)}, options);
  renderer.Render(camera, 3);
  SceneGradients gradients;
  renderer.Backward(Constant(camera, 0.0f, 0.0f, 1.0f / 256.0f), &gradients);
  EXPECT_NEAR(gradients.objects[0].pose.translation.z(), -1.0, 1e-5);
  EXPECT_NEAR(gradients.camera.pose.translation.z(), 1.0, 1e-5);
  EXPECT_NEAR(gradients.camera.fx, 0.0, 1e-5);
}

TEST(GradientGate, TrianglesAndAQuad) {
  for (const GateScene& scene : {TriangleScene(24), ClippedTriangleScene(24),
                                 OccludingTrianglesScene(24), TexturedQuadScene(24)}) {
    const auto gradients = Gradients(scene, 24, 100000);
    ExpectGate(CompareFields(scene, 3, 32, 1, gradients), "3 fields", 0.03);
    ExpectGate(ComparePose(scene, 0, 5, 32, 1, gradients), "camera", 0.03);
  }
}

TEST(GradientGate, ABumpySphere) {
  const GateScene scene = BumpySphereScene(24, 8);
  const auto gradients = Gradients(scene, 24, 100000);
  ExpectGate(CompareFields(scene, 6, 32, 1, gradients), "6 fields", 0.03);
}

// The discontinuity at every visible edge of a flat-shaded mesh moves with the edge.
TEST(GradientGate, AFlatShadedSphere) {
  GateScene scene = BumpySphereScene(24, 3);
  scene.options.smooth_normals = false;
  const auto gradients = Gradients(scene, 24, 200000);
  ExpectGate(CompareFields(scene, 4, 32, 1, gradients), "flat", 0.03);
}

// The inside of a bowl: its far rim is a silhouette, and the visible faces are back faces.
TEST(GradientGate, AnOpenMeshSeenFromInside) {
  GateScene scene = BumpySphereScene(24, 6);
  core::TriangleMesh& mesh = scene.objects[0].mesh;
  const Eigen::Vector3d towards = scene.camera.position().normalized();
  std::erase_if(mesh.triangles,
                [&](const Eigen::Vector3i& t) { return mesh.vertices[t[0]].dot(towards) > 0.1; });
  const auto gradients = Gradients(scene, 24, 100000);
  ExpectGate(CompareFields(scene, 4, 32, 1, gradients), "bowl", 0.03);
}

// Three sheets at one edge.
TEST(GradientGate, AnEdgeOfThreeFaces) {
  GateScene scene = TriangleScene(24);
  core::TriangleMesh& mesh = scene.objects[0].mesh;
  mesh.vertices.emplace_back(0.3, 0.1, 0.2);
  mesh.vertices.emplace_back(-0.1, -0.3, 0.2);
  mesh.triangles = {{0, 2, 1}, {0, 2, 3}, {2, 0, 4}};
  Paint(&scene.objects[0]);
  scene.options.smooth_normals = false;
  const auto gradients = Gradients(scene, 24, 100000);
  ExpectGate(CompareFields(scene, 4, 32, 1, gradients), "three faces", 0.03);
}

// The image is linear in colours, texels and light: differences are exact up to rounding.
TEST(Differentiable, ColorsTexelsAndLight) {
  GateScene quad = TexturedQuadScene(24);
  Paint(&quad.objects[0]);
  const auto gradients = Gradients(quad, 4, 100);
  DifferentiableOptions options = quad.options;
  options.samples_per_side = 4;
  DifferentiableRenderer renderer(quad.objects, options);
  const DifferentiableBuffers images = LossImages(quad);
  const auto slope = [&](const std::function<void(float)>& apply) {
    const auto loss = [&](float by) {
      apply(by);
      return LossesOf(renderer.Render(quad.camera, 5), images)[kColor];
    };
    const double up = loss(0.25f), down = loss(-0.25f);
    loss(0.0f);
    return (up - down) / 0.5;
  };
  const SceneGradients& of = gradients[kColor];
  const double scale = std::abs(Dot(images.color, renderer.Render(quad.camera, 5).color));
  for (const int v : {0, 4, 7}) {
    const double d = slope([&](float by) {
      std::vector<Eigen::Vector3f> colors = quad.objects[0].vertex_colors;
      colors[v][1] += by;
      renderer.SetVertexColors(0, colors);
    });
    EXPECT_NEAR(of.objects[0].vertex_colors[v][1], d, 1e-4 * scale);
    EXPECT_GT(std::abs(d), 1e-3 * scale);
  }
  for (const int i : {3 * 30, 3 * 31 + 1, 3 * 22 + 2}) {
    const double d = slope([&](float by) {
      core::FloatImage texture = quad.objects[0].texture;
      texture.values[i] += by;
      renderer.SetTexture(0, texture);
    });
    EXPECT_NEAR(of.objects[0].texture.values[i], d, 1e-4 * scale);
    EXPECT_GT(std::abs(d), 1e-3 * scale);
  }
  for (int i = 0; i < 9; ++i) {
    const double d = slope([&](float by) {
      SphericalHarmonicsLight light = options.light;
      light.radiance(i, 2) += 0.1f * by;
      renderer.SetLight(light);
    });
    EXPECT_NEAR(0.1 * of.light(i, 2), d, 1e-4 * scale) << i;
  }
}

// A textured square cut along its middle, both halves with their own vertices and discontinuous
// texture coordinates: the welded cut is not a silhouette, but the texture's discontinuity is
// sampled.
TEST(GradientGate, ASeamIsNoOutlineButMayStep) {
  GateScene scene = TexturedQuadScene(24);
  DifferentiableObject& quad = scene.objects[0];
  const std::size_t n = quad.mesh.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    quad.mesh.vertices.push_back(Eigen::Vector3d(quad.mesh.vertices[i]));
  }
  for (std::size_t f = 4; f < 8; ++f) {  // the upper half
    for (int k = 0; k < 3; ++k) {
      quad.mesh.triangles[f][k] += static_cast<int>(n);
      quad.corner_uvs[3 * f + k] += Eigen::Vector2f(0.3f, 0.1f);
    }
  }
  const auto gradients = Gradients(scene, 24, 100000);
  ExpectGate(CompareFields(scene, 4, 32, 1, gradients), "seam", 0.03);
  const DifferentiableRenderer renderer(scene.objects, scene.options);
  EXPECT_EQ(renderer.WeldedVertices(0)[n + 4], 4);
}

TEST(Differentiable, BackwardAddsAndTheSameSeedGivesTheSameBytes) {
  const GateScene scene = BumpySphereScene(32, 6);
  const DifferentiableBuffers images = LossImages(scene);
  DifferentiableRenderer one(scene.objects, scene.options), two(scene.objects, scene.options);
  SceneGradients first, second;
  one.Render(scene.camera, 9);
  one.Backward(images, &first);
  two.Render(scene.camera, 4);
  two.Backward(images, &second);
  second.SetZero();
  const DifferentiableBuffers& again = two.Render(scene.camera, 9);
  EXPECT_EQ(again.color.values, one.Render(scene.camera, 9).color.values);
  two.Backward(images, &second);
  for (std::size_t i = 0; i < first.objects[0].vertices.size(); ++i) {
    ASSERT_EQ(first.objects[0].vertices[i], second.objects[0].vertices[i]) << i;
  }
  EXPECT_EQ(first.light, second.light);
  const Eigen::Vector3d once = second.camera.pose.rotation;
  two.Backward(images, &second);
  EXPECT_NEAR((second.camera.pose.rotation - 2.0 * once).norm(), 0.0, 1e-9 * once.norm());
}

TEST(Differentiable, MovedVerticesAreDrawnWhereTheyWent) {
  GateScene scene = BumpySphereScene(32, 6);
  DifferentiableRenderer moved(scene.objects, scene.options);
  moved.Render(scene.camera, 1);
  for (Eigen::Vector3d& v : scene.objects[0].mesh.vertices)
    v = 0.7 * v + Eigen::Vector3d(0, 0.1, 0);
  moved.SetVertices(0, scene.objects[0].mesh.vertices);
  DifferentiableRenderer fresh(scene.objects, scene.options);
  const DifferentiableBuffers& a = moved.Render(scene.camera, 2);
  const DifferentiableBuffers& b = fresh.Render(scene.camera, 2);
  EXPECT_EQ(a.mask.values, b.mask.values);
  for (std::size_t i = 0; i < a.color.values.size(); ++i) {
    ASSERT_NEAR(a.color.values[i], b.color.values[i], 1e-5);
  }
}

TEST(Differentiable, BadInputIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const core::Camera camera = DifferentiableFromAbove(2.0, 8, 8.0);
  EXPECT_THROW(DifferentiableRenderer({DifferentiableObject{}}), core::Error);
  DifferentiableObject square = DifferentiableSquare(1.0, 0.0);
  square.vertex_colors.resize(3);
  EXPECT_THROW(DifferentiableRenderer({square}), core::Error);
  square = DifferentiableSquare(1.0, 0.0);
  square.texture = core::FloatImage(2, 2, 3);
  EXPECT_THROW(DifferentiableRenderer({square}), core::Error) << "no texture coordinates";
  square = DifferentiableSquare(1.0, 0.0);
  square.mesh.vertices[0].x() = 1e300;
  EXPECT_THROW(DifferentiableRenderer({square}), core::Error);
  DifferentiableOptions options;
  options.samples_per_side = 0;
  EXPECT_THROW(DifferentiableRenderer({DifferentiableSquare(1.0, 0.0)}, options), core::Error);

  DifferentiableRenderer renderer({DifferentiableSquare(1.0, 0.0)});
  SceneGradients gradients;
  EXPECT_THROW(renderer.Backward({}, &gradients), core::Error) << "no picture yet";
  core::Camera bad = camera;
  bad.fx = nan;
  EXPECT_THROW(renderer.Render(bad, 1), core::Error);
  renderer.Render(camera, 1);
  DifferentiableBuffers images;
  images.mask = core::FloatImage(4, 8, 1);
  EXPECT_THROW(renderer.Backward(images, &gradients), core::Error);
  EXPECT_THROW(renderer.SetVertices(0, {Eigen::Vector3d::Zero()}), core::Error);
  std::vector<Eigen::Vector3d> vertices = renderer.object(0).mesh.vertices;
  vertices[2].y() = nan;
  EXPECT_THROW(renderer.SetVertices(0, vertices), core::Error);
}

}  // namespace
}  // namespace simwright::render
