#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "render/rigid_render.h"

namespace simwright::render {

// Returns a closed box centred at the origin, its six sides in six colours.
inline core::TexturedMesh PaintedBox(const Eigen::Vector3d& size) {
  core::TexturedMesh box;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const auto first = static_cast<int>(box.mesh.vertices.size());
      for (const auto& [s, t] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
        Eigen::Vector3d corner;
        corner[axis] = side * size[axis];
        corner[a] = s * size[a];
        corner[b] = t * size[b];
        box.mesh.vertices.push_back(corner);
      }
      const int p = side > 0 ? 1 : 3, q = side > 0 ? 3 : 1;
      box.mesh.triangles.emplace_back(first, first + p, first + 2);
      box.mesh.triangles.emplace_back(first, first + 2, first + q);
      const auto color = static_cast<float>(box.materials.size());
      box.materials.push_back(
          {"side", {0.15f * color + 0.1f, 0.9f - 0.12f * color, 0.5f, 1.0f}, -1});
      const auto material = static_cast<int>(box.materials.size()) - 1;
      box.triangle_material.insert(box.triangle_material.end(), {material, material});
    }
  }
  return box;
}

// Returns a sphere of `rings` x 2 rings quads with vertices on the exact surface.
inline core::TexturedMesh FineSphere(double radius, int rings) {
  core::TexturedMesh ball;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = std::numbers::pi * i / rings,
                   turn = 2.0 * std::numbers::pi * j / sectors;
      ball.mesh.vertices.emplace_back(radius * std::sin(polar) * std::cos(turn),
                                      radius * std::sin(polar) * std::sin(turn),
                                      radius * std::cos(polar));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      ball.mesh.triangles.emplace_back(a, a + sectors, b + sectors);
      ball.mesh.triangles.emplace_back(a, b + sectors, b);
    }
  }
  return ball;
}

// Returns a square of two triangles in z = 0 with a texture of 8 x 8 colours.
inline core::TexturedMesh TexturedSquare(double side) {
  core::TexturedMesh square;
  const double h = 0.5 * side;
  square.mesh.vertices = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  square.triangle_material = {0, 0};
  square.materials.push_back({"print", {0.9f, 0.8f, 1.0f, 1.0f}, 0});
  core::Image texture(8, 8, 3);
  for (std::size_t i = 0; i < texture.pixels.size(); ++i) {
    texture.pixels[i] = static_cast<std::uint8_t>((i * 67 + 31) % 256);
  }
  square.textures.push_back(texture);
  return square;
}

// Memory of one image, all four buffers.
struct RenderedImage {
  explicit RenderedImage(const core::Camera& camera)
      : width(camera.width),
        height(camera.height),
        rgb(3 * Pixels(), 77),
        depth(Pixels(), -7.0f),
        normal(3 * Pixels(), -7.0f),
        label(Pixels(), -7) {}

  std::size_t Pixels() const { return static_cast<std::size_t>(width) * height; }
  std::size_t Index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  ImageBuffers Buffers() { return {rgb.data(), depth.data(), label.data(), normal.data()}; }
  Eigen::Vector3f Normal(std::size_t i) const {
    return {normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]};
  }
  bool operator==(const RenderedImage&) const = default;

  int width, height;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth, normal;
  std::vector<std::int32_t> label;
};

inline RenderedImage Rendered(const RigidScene& scene, const core::Camera& camera,
                              const RigidRenderOptions& options = {}) {
  RenderedImage image(camera);
  RenderRigid(scene, camera, image.Buffers(), options);
  return image;
}

// Returns a pose with a rotation about all axes.
inline Eigen::Isometry3d TurnedPose(double x, double y, double z, double angle) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, 0.8, -0.5).normalized()));
  return pose;
}

}  // namespace simwright::render
