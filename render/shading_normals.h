#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace simwright::render {

// The normals of a triangle, unit; zero for a triangle without area.
struct TriangleNormals {
  // The corners' normals: area-weighted vertex normals where the surface is smooth within 40
  // degrees, else the face's own.
  Eigen::Vector3f corners[3];
  Eigen::Vector3f face;

  // Returns the shading normal at barycentric coordinates (u, v), unit or zero.
  Eigen::Vector3f At(float u, float v) const {
    const Eigen::Vector3f sum = (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
    const float square = sum.squaredNorm();
    return square > 0.0f ? Eigen::Vector3f(sum / std::sqrt(square)) : sum;
  }
};

// Turns a shading normal to the side from which `ray` comes: flips it for a back face. If the
// smooth normal of a front face seen at a grazing angle points away, it is moved to the horizon,
// not behind the face. `normal` and `face` are unit.
Eigen::Vector3f FacingNormal(Eigen::Vector3f normal, const Eigen::Vector3f& face,
                             const Eigen::Vector3f& ray);

// Returns the normals of each triangle, from vertex positions. (N x 3, M x 3)
std::vector<TriangleNormals> NormalsOfTriangles(const std::vector<Eigen::Vector3f>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles);

}  // namespace simwright::render
