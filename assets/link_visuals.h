#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/urdf_reader.h"
#include "core/mesh.h"

namespace simwright::assets {

// A visual shape of a link as its URDF states it: a mesh file that is not read yet, or a primitive.
struct LinkVisual {
  int link = 0;             // in UrdfModel::links
  core::TriangleMesh mesh;  // m, link frame; empty for a mesh file
  std::string file;         // the mesh file, absolute; empty for a primitive
  Eigen::Affine3d link_from_file = Eigen::Affine3d::Identity();
  std::optional<Eigen::Vector4f> color;  // RGBA of the URDF, sRGB
};

// Returns the visual shapes of all links, in their order; for a link without any its collision
// shapes.
std::vector<LinkVisual> LinkVisuals(const UrdfModel& model);

// Returns the mesh of a visual in its link's frame, m. A file keeps its own materials, unless the
// URDF gives a colour and the file has no texture; `plain` (RGBA, sRGB) colours a primitive without
// colour. Throws core::Error as ReadMesh does.
core::TexturedMesh ReadVisual(const LinkVisual& visual, const Eigen::Vector4f& plain);

// Returns `mesh` with one material of this colour.
core::TexturedMesh InOneColor(core::TriangleMesh mesh, const Eigen::Vector4f& color);

}  // namespace simwright::assets
