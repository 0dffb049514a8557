#pragma once

#include "assets/articulated_asset.h"
#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"

namespace simwright::assets {

inline ArticulatedLink SampleLink(const std::string& name, const std::string& label,
                                  const Eigen::Vector3d& size, const Eigen::Vector3d& center) {
  ArticulatedLink link;
  link.name = name;
  link.label = label;
  link.material = "wood";
  core::TriangleMesh mesh = BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(center)), &mesh);
  const auto properties = geometry::SolidMassProperties(mesh, 600.0);
  link.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
  link.volume = properties.volume;
  link.densities = {600.0};
  link.parts = {mesh};
  link.visual.mesh = mesh;
  link.visual.triangle_material.assign(mesh.triangles.size(), 0);
  link.visual.triangle_material[3] = 1;
  link.visual.materials = {{"oak", {0.7f, 0.5f, 0.3f, 1.0f}, -1},
                           {"mark", {0.1f, 0.1f, 0.8f, 1.0f}, -1}};
  return link;
}

// A chest with a door on a hinge and a handle on it.
inline ArticulatedAsset SampleArticulated() {
  ArticulatedAsset asset;
  asset.name = "sample_chest";
  asset.source = "test";
  asset.seed = 5;
  asset.parameters.category = "chest";
  asset.features = {{"handle", "bar"}};
  asset.links = {SampleLink("body", "body", {0.3, 0.4, 0.5}, {0.05, 0, 0.25}),
                 SampleLink("door", "door", {0.02, 0.4, 0.5}, {-0.01, -0.2, 0.0}),
                 SampleLink("handle_0", "handle", {0.03, 0.02, 0.1}, {0, 0, 0})};
  Joint hinge;
  hinge.name = "door_joint";
  hinge.parent = "body";
  hinge.child = "door";
  hinge.type = JointType::kRevolute;
  hinge.parent_from_joint.translation() = Eigen::Vector3d(-0.103, 0.2, 0.25);
  hinge.axis = -Eigen::Vector3d::UnitZ();
  hinge.upper = 1.7;
  hinge.damping = 0.12;
  hinge.friction = 0.34;
  hinge.effort = 9.0;
  hinge.velocity = 5.0;
  Joint seat;
  seat.name = "handle_0_joint";
  seat.parent = "door";
  seat.child = "handle_0";
  seat.parent_from_joint.translation() = Eigen::Vector3d(-0.05, -0.37, 0.0);
  asset.joints = {hinge, seat};
  return asset;
}

// The chest with a texture of its own on the first look of all links.
inline ArticulatedAsset TexturedArticulated() {
  ArticulatedAsset asset = SampleArticulated();
  core::Image texture(8, 8, 3);
  for (size_t i = 0; i < texture.pixels.size(); ++i) {
    texture.pixels[i] = static_cast<std::uint8_t>(37 * i % 251);
  }
  for (ArticulatedLink& link : asset.links) {
    link.visual.textures = {texture};
    link.visual.materials[0].texture = 0;
    for (size_t i = 0; i < 3 * link.visual.mesh.triangles.size(); ++i) {
      link.visual.corner_uvs.emplace_back(0.01f * static_cast<float>(i % 90), 0.25f);
    }
  }
  return asset;
}

}  // namespace simwright::assets
