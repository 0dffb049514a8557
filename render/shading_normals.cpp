#include "render/shading_normals.h"

#include <cstddef>

#include <Eigen/Geometry>

namespace simwright::render {
namespace {

constexpr float kSmoothCosine = 0.766f;  // 40 degrees

}  // namespace

Eigen::Vector3f FacingNormal(Eigen::Vector3f normal, const Eigen::Vector3f& face,
                             const Eigen::Vector3f& ray) {
  if (normal.dot(ray) <= 0.0f) return normal;
  if (face.dot(ray) > 0.0f) normal = -normal;
  const float away = normal.dot(ray) / ray.squaredNorm();
  return away > 0.0f ? (normal - away * ray).stableNormalized() : normal;
}

std::vector<TriangleNormals> NormalsOfTriangles(const std::vector<Eigen::Vector3f>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3f> smooth(vertices.size(), Eigen::Vector3f::Zero());
  std::vector<TriangleNormals> normals(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3i& t = triangles[i];
    const Eigen::Vector3f& a = vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3f area = (vertices[static_cast<std::size_t>(t[1])] - a)
                                     .cross(vertices[static_cast<std::size_t>(t[2])] - a);
    for (int k = 0; k < 3; ++k) smooth[static_cast<std::size_t>(t[k])] += area;
    normals[i].face = area.stableNormalized();
  }
  for (Eigen::Vector3f& normal : smooth) normal.stableNormalize();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f& normal = smooth[static_cast<std::size_t>(triangles[i][k])];
      const bool is_smooth = normal.dot(normals[i].face) > kSmoothCosine;
      normals[i].corners[k] = is_smooth ? normal : normals[i].face;
    }
  }
  return normals;
}

}  // namespace simwright::render
