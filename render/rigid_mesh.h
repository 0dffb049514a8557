#pragma once

#include <memory>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "core/pbr_look.h"

namespace simwright::render {

// A mesh prepared for RenderRigid: a ray tree in the mesh's own frame, shading normals and colours.
// Immutable and thread-safe; any number of scenes share one.
class RigidMesh {
 public:
  // Copies what it needs from `mesh` (m) and `look`, the materials' reflection; an empty look makes
  // Lambertian surfaces. Throws core::Error for an invalid mesh or one without faces, or a look
  // with a map that is missing.
  explicit RigidMesh(const core::TexturedMesh& mesh, const core::PbrLook& look = {});
  ~RigidMesh();
  RigidMesh(const RigidMesh&) = delete;
  RigidMesh& operator=(const RigidMesh&) = delete;

  const Eigen::AlignedBox3f& bounds() const;  // m, mesh frame
  int triangle_count() const;

  struct Content;
  const Content& content() const { return *content_; }  // for RenderRigid alone

 private:
  std::unique_ptr<const Content> content_;
};

}  // namespace simwright::render
