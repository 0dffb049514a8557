#include "sim/rigid_body.h"

#include <algorithm>
#include <limits>

#include "assets/joint_poses.h"
#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/mass_properties.h"

namespace simwright::sim {

RigidBody BodyFromAsset(const assets::Asset& asset) {
  return {asset.name,     asset.parts,       asset.inertial,
          asset.friction, asset.restitution, asset.rolling_friction};
}

RigidBody BodyFromUrdf(const assets::UrdfModel& model) {
  RigidBody body;
  body.name = model.name;
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  geometry::MassProperties total;
  for (size_t i = 0; i < model.links.size(); ++i) {
    const assets::UrdfLink& link = model.links[i];
    for (const assets::UrdfShape& shape : link.collisions) {
      core::TriangleMesh part = shape.mesh;
      core::Transform(Eigen::Affine3d(poses[i]), &part);
      body.parts.push_back(std::move(part));
      body.friction = link.friction;
      body.restitution = link.restitution;
      body.rolling_friction = link.rolling_friction;
    }
    if (!link.inertial) continue;
    const geometry::MassProperties one = geometry::Transformed(
        poses[i],
        {0.0, link.inertial->mass, link.inertial->center_of_mass, link.inertial->inertia});
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
  }
  if (body.parts.empty()) {
    throw core::Error("no link has a collision shape", model.name, "add <collision> elements");
  }
  if (!(total.mass > 0.0)) {
    throw core::Error("no link has a mass", model.name, "add <inertial> elements");
  }
  body.inertial = {total.mass, total.center_of_mass, total.inertia};
  return body;
}

RigidBody SphereBody(double radius, double mass) {
  RigidBody body;
  body.name = "ball";
  body.parts.push_back(assets::SphereMesh(radius, 24));
  body.inertial = {mass, Eigen::Vector3d::Zero(),
                   Eigen::Matrix3d::Identity() * (0.4 * mass * radius * radius)};
  return body;
}

double LowestPoint(const RigidBody& body, const Eigen::Isometry3d& world_from_body) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const core::TriangleMesh& part : body.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) {
      lowest = std::min(lowest, (world_from_body * vertex).z());
    }
  }
  return lowest;
}

double Radius(const RigidBody& body) {
  double radius = 0.0;
  for (const core::TriangleMesh& part : body.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) {
      radius = std::max(radius, (vertex - body.inertial.center_of_mass).norm());
    }
  }
  return radius;
}

}  // namespace simwright::sim
