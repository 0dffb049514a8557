#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::texture {

inline constexpr int kGutter = 4;  // texels around a chart that take part in bilinear lookups

// The surface point of each texel of an atlas. Texels of the gutter, up to kGutter outside a chart,
// belong to the triangle next to them: their barycentric coordinates are negative.
struct TexelMap {
  int size = 0;                              // texels per side
  std::vector<std::int32_t> triangle;        // (size x size), rows from the top; -1: none
  std::vector<Eigen::Vector3f> barycentric;  // (size x size), sum 1, of the texel's centre
  std::vector<std::uint8_t> inside;          // (size x size), 1 where a triangle covers the centre

  std::size_t Index(int x, int y) const { return static_cast<std::size_t>(y) * size + x; }
  std::size_t count() const { return triangle.size(); }
  // Returns the texel's point on the plane of its triangle (m), for gutter texels extrapolated.
  Eigen::Vector3d Position(const core::TriangleMesh& mesh, std::size_t texel) const;
  // Returns the barycentric coordinates of the point of the triangle that is nearest to the texel.
  Eigen::Vector3f OnTriangle(std::size_t texel) const;
};

// Maps `size` x `size` texels to the triangles whose corners have the texture coordinates `uvs`
// (3M x 2, [0, 1], origin lower left). Throws core::Error if their number is wrong.
TexelMap MakeTexelMap(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                      int size);

// Returns true if the texture coordinates can carry a texture of their own: inside [0, 1], each
// triangle with area has some, and at most `overlap` of the covered texels are claimed twice.
bool UvsAreUnique(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                  double overlap = 0.01);

// Gives each texel that belongs to no chart the mean colour of its neighbours that do, `rings`
// texels far, and the others the mean of all; `image` has the map's size.
void FillBetweenCharts(const TexelMap& map, int rings, core::Image* image);

}  // namespace simwright::texture
