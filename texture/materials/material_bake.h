#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/mesh.h"
#include "texture/materials/surface_material.h"
#include "texture/painting/texel_map.h"

namespace simwright::texture {

// The materials of a mesh by triangle.
struct MaterialPlan {
  std::vector<SurfaceMaterial> materials;
  // For each material the index of the one that the inside of a vessel has instead, or -1; and of
  // the one that a handle or spout has, which sticks out of a round body.
  std::vector<int> inside_material, handle_material;
  std::vector<PartFrame> frames;
  std::vector<int> triangle_material, triangle_frame;  // (M)
};

// The maps of a surface, all of the size of the texel map. Normals are in tangent space, y up
// (OpenGL); the others are grey.
struct MaterialMaps {
  core::Image color, roughness, metallic, normal;
  bool any_metal = false;
};

// Returns a frame per connected piece of triangles with one label, and the piece of each triangle.
// Vertices at one place are one. A piece is round if its outline from above is a circle; a handle
// may stick out. `labels` has one entry per triangle.
struct PieceFrames {
  std::vector<PartFrame> frames;
  std::vector<int> triangle_frame;  // (M)
};
PieceFrames FramesOfPieces(const core::TriangleMesh& mesh, const std::vector<int>& labels);

// Returns the frame of all triangles of each label 0 .. count - 1, connected or not.
std::vector<PartFrame> FramesOfLabels(const core::TriangleMesh& mesh,
                                      const std::vector<int>& labels, int count);

// Returns for each triangle whether it lies inside a vessel: most horizontal directions from it,
// but not all of those upwards, are blocked by the mesh itself.
std::vector<std::uint8_t> InsideOfVessel(const core::TriangleMesh& mesh);

// Returns true for a point outside the circle of a round body: on its handle or spout.
bool IsOnHandle(const PartFrame& frame, const Eigen::Vector3f& position);

// Evaluates the plan at each texel of the map. `uvs` (3M x 2) are those of the map. Throws
// core::Error if sizes do not match, and core::Cancelled.
MaterialMaps BakeMaterials(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector2f>& uvs,
                           const TexelMap& map, const MaterialPlan& plan);

}  // namespace simwright::texture
