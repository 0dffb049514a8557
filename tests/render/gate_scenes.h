#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "tests/render/gradient_gate.h"

// The scenes on which gradients are compared with finite differences.
namespace simwright::render {

constexpr double kSceneScale = 0.4;  // objects are about 0.6 m across

inline core::Camera GateCamera(int size) {
  return core::OrbitCamera(Eigen::Vector3d::Zero(), 3.0 * kSceneScale, 0.35, 0.6, 0.75, size, size);
}

// Vertex colours that vary smoothly over the mesh.
inline void Paint(DifferentiableObject* object) {
  object->vertex_colors.clear();
  const SmoothFunction red(40, 4.0), green(45, 4.0), blue(50, 4.0);
  for (const Eigen::Vector3d& v : object->mesh.vertices) {
    const Eigen::Vector3d color(red(v), green(v), blue(v));
    object->vertex_colors.push_back((0.2 * color).cast<float>() + Eigen::Vector3f::Constant(0.5f));
  }
}

inline GateScene TriangleScene(int size) {
  GateScene scene;
  scene.camera = GateCamera(size);
  scene.objects.resize(1);
  scene.objects[0].mesh.vertices = {{0.3, -0.8, -0.4}, {0.1, 0.9, -0.3}, {-0.3, 0.1, 0.8}};
  for (Eigen::Vector3d& v : scene.objects[0].mesh.vertices) v *= kSceneScale;
  scene.objects[0].mesh.triangles = {{0, 1, 2}};
  Paint(&scene.objects[0]);
  scene.options.render_normals = true;
  return scene;
}

// Extends beyond the image on two sides.
inline GateScene ClippedTriangleScene(int size) {
  GateScene scene = TriangleScene(size);
  scene.objects[0].mesh.vertices[1] = kSceneScale * Eigen::Vector3d(0.1, 2.6, -0.5);
  scene.objects[0].mesh.vertices[2] = kSceneScale * Eigen::Vector3d(-0.4, 0.2, 1.9);
  return scene;
}

// One corner is behind the camera.
inline GateScene NearTriangleScene(int size) {
  GateScene scene = TriangleScene(size);
  const Eigen::Vector3d eye = scene.camera.position();
  scene.objects[0].mesh.vertices[1] = 1.3 * eye + kSceneScale * Eigen::Vector3d(-0.2, 0.3, -0.6);
  return scene;
}

inline GateScene OccludingTrianglesScene(int size) {
  GateScene scene = TriangleScene(size);
  DifferentiableObject behind;
  behind.mesh.vertices = {{-0.6, -0.7, 0.5}, {-0.7, 0.9, 0.6}, {-0.5, 0.0, -0.8}};
  for (Eigen::Vector3d& v : behind.mesh.vertices) v *= kSceneScale;
  behind.mesh.triangles = {{0, 1, 2}};
  Paint(&behind);
  for (Eigen::Vector3f& color : behind.vertex_colors) color = Eigen::Vector3f::Ones() - color;
  scene.objects.push_back(behind);
  return scene;
}

// The points of a triangle's grid with `n` steps per side, as on an icosahedron's face: a bumpy
// sphere of 20 n^2 faces.
inline core::TriangleMesh BumpySphere(int n) {
  const double g = std::numbers::phi;
  const std::vector<Eigen::Vector3d> corners = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  const std::vector<Eigen::Vector3i> faces = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  core::TriangleMesh mesh;
  std::map<std::array<long, 3>, int> found;
  const auto vertex = [&](const Eigen::Vector3i& face, int i, int j) {
    const Eigen::Vector3d p =
        ((n - i - j) * corners[face[0]] + i * corners[face[1]] + j * corners[face[2]]).normalized();
    const auto [at, added] = found.try_emplace(
        {std::lround(1e7 * p.x()), std::lround(1e7 * p.y()), std::lround(1e7 * p.z())},
        static_cast<int>(mesh.vertices.size()));
    if (added) {
      const double bumps = std::sin(5.0 * p.x()) * std::cos(4.0 * p.y()) * std::cos(4.5 * p.z());
      mesh.vertices.push_back(kSceneScale * (0.85 + 0.05 * bumps) * p);
    }
    return at->second;
  };
  for (const Eigen::Vector3i& face : faces) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        mesh.triangles.emplace_back(vertex(face, i, j), vertex(face, i + 1, j),
                                    vertex(face, i, j + 1));
        if (i + j + 1 == n) continue;
        mesh.triangles.emplace_back(vertex(face, i + 1, j), vertex(face, i + 1, j + 1),
                                    vertex(face, i, j + 1));
      }
    }
  }
  return mesh;
}

inline GateScene BumpySphereScene(int size, int n) {
  GateScene scene;
  scene.camera = GateCamera(size);
  scene.objects.resize(1);
  scene.objects[0].mesh = BumpySphere(n);
  Paint(&scene.objects[0]);
  scene.options.render_normals = true;
  scene.options.lit = true;
  return scene;
}

// A quad of eight triangles, bent, with a smooth texture, lit.
inline GateScene TexturedQuadScene(int size) {
  GateScene scene;
  scene.camera = GateCamera(size);
  scene.objects.resize(1);
  DifferentiableObject& quad = scene.objects[0];
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      quad.mesh.vertices.push_back(
          kSceneScale * Eigen::Vector3d(0.15 * ((i + j) % 2), 0.75 * (i - 1), 0.6 * (j - 1)));
    }
  }
  const auto uv = [&](int v) {
    return Eigen::Vector2f(0.1f + 0.4f * static_cast<float>(v % 3),
                           0.1f + 0.4f * static_cast<float>(v / 3));
  };
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      quad.mesh.triangles.emplace_back(a, a + 1, a + 4);
      quad.mesh.triangles.emplace_back(a, a + 4, a + 3);
    }
  }
  for (const Eigen::Vector3i& t : quad.mesh.triangles) {
    for (int k = 0; k < 3; ++k) quad.corner_uvs.push_back(uv(t[k]));
  }
  quad.texture = core::FloatImage(9, 7, 3);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      for (int c = 0; c < 3; ++c) {
        quad.texture.At(x, y)[c] =
            static_cast<float>(0.5 + 0.2 * SmoothFunction(60 + c, 0.7)({1.0 * x, 1.0 * y, 0.0}));
      }
    }
  }
  scene.options.render_normals = true;
  scene.options.lit = true;
  return scene;
}

}  // namespace simwright::render
