#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "core/pbr_look.h"
#include "render/hit.h"
#include "render/ray_packet.h"
#include "render/reflection.h"
#include "render/shading_normals.h"

namespace simwright::render {

// Meshes placed in the world for ray queries (RayTree). If vertices move (`MoveVertices`), the tree
// is refitted, not rebuilt. Queries are const and thread-safe.
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Adds a copy of the mesh's geometry at `world_from_mesh`; `mesh` itself must outlive the scene,
  // since its colours are read when shading, and so must `look`, the materials' reflection. Without
  // a look (null) surfaces are Lambertian. Returns the instance's index. Throws core::Error for an
  // invalid mesh or one without faces, or a look with a map that is missing.
  int Add(const core::TexturedMesh* mesh,
          const Eigen::Isometry3d& world_from_mesh = Eigen::Isometry3d::Identity(),
          const core::PbrLook* look = nullptr);

  // Replaces the vertices of an instance (N x 3, the same number, mesh frame). Call Commit
  // afterwards.
  void MoveVertices(int instance, const std::vector<Eigen::Vector3d>& vertices);

  // Builds or refits the trees; required after Add and MoveVertices, before any query.
  void Commit();

  // Returns the nearest hit of origin + t * direction with t in (near, far).
  Hit Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near = 0.0f,
                float far = 1e30f) const;
  // Writes the hits of nearby rays from one origin, as Intersect returns them, several times
  // faster. PacketHits::part is the instance; untraced rays have no hit.
  void IntersectPacket(const Eigen::Vector3f& origin, const PacketDirections& directions,
                       PacketHits* hits) const;
  // Returns true if anything is hit with t in (near, far).
  bool Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) const;

  int size() const;
  const core::TexturedMesh& mesh(int instance) const;
  // Returns the look that the instance was added with; null if it has none.
  const core::PbrLook* look(int instance) const;
  // Returns true if any instance has a look.
  bool HasLooks() const;
  // Returns a triangle's corner positions in the world, one per column. (3 x 3)
  Eigen::Matrix3f Corners(int instance, int triangle) const;
  // Returns the triangle's normals in the world.
  const TriangleNormals& Normals(int instance, int triangle) const;
  // Returns the shading normal (area-weighted vertex normals where the surface is smooth within 40
  // degrees, else the face's own), unit, in the world.
  Eigen::Vector3f ShadingNormal(const Hit& hit) const;
  // Returns the reflection of the instance's look at the hit, and the shading normal that its
  // normal map makes of `normal` (unit, world, facing the camera).
  SurfaceReflection ReflectionAt(const Hit& hit, const Eigen::Vector3f& normal,
                                 Eigen::Vector3f* perturbed) const;
  // Returns the RGBA albedo, sRGB, at the hit.
  Eigen::Vector4f Albedo(const Hit& hit) const;

  Eigen::AlignedBox3f bounds() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace simwright::render
