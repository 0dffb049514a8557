#pragma once

#include <memory>
#include <string>

#include "assets/primitive_meshes.h"
#include "certificate/placed_scene.h"
#include "core/mesh.h"

namespace simwright::certificate {

inline std::shared_ptr<const BodyModel> ModelOf(core::TriangleMesh mesh, double mass,
                                                double friction = 0.5) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  sim::RigidBody body;
  body.name = "body";
  body.parts.push_back(std::move(mesh));
  body.friction = friction;
  const Eigen::Vector3d squares = box.sizes().cwiseAbs2();
  body.inertial = {mass, box.center(),
                   mass / 12.0 *
                       Eigen::Vector3d(squares.y() + squares.z(), squares.x() + squares.z(),
                                       squares.x() + squares.y())
                           .asDiagonal()
                           .toDenseMatrix()};
  return std::make_shared<const BodyModel>(body);
}

inline std::shared_ptr<const BodyModel> BoxModel(const Eigen::Vector3d& size, double mass = 0.2) {
  return ModelOf(assets::BoxMesh(size), mass);
}

inline void Put(const std::string& name, std::shared_ptr<const BodyModel> model,
                const Eigen::Vector3d& at, PlacedScene* scene, bool fixed = false) {
  scene->bodies.push_back(
      {name, std::move(model), Eigen::Isometry3d(Eigen::Translation3d(at)), fixed});
}

// A table, 0.6 m by 0.8 m and 0.3 m high, whose front edge is at x = 0, and on it an upright
// cylinder, "apple", at (x, y). The apple is body 1.
inline PlacedScene TableWithApple(double x = 0.15, double y = 0.0, double diameter = 0.06,
                                  double height = 0.07) {
  PlacedScene scene;
  Put("table", BoxModel({0.6, 0.8, 0.3}), {0.3, 0.0, 0.15}, &scene, true);
  Put("apple", ModelOf(assets::CylinderMesh(0.5 * diameter, height, 32), 0.15),
      {x, y, 0.3 + 0.5 * height}, &scene);
  return scene;
}

inline constexpr int kApple = 1;

// The robot stands half a metre in front of the table, 12 cm below its top.
inline Eigen::Isometry3d InFrontOfTable() {
  return Eigen::Isometry3d(Eigen::Translation3d(-0.4, 0.0, 0.18));
}

// Walls 3 cm thick and 30 cm high around the apple of TableWithApple and over it, welded but for
// the one towards the robot, "door".
inline void AddCell(PlacedScene* scene) {
  Put("back", BoxModel({0.03, 0.26, 0.3}), {0.285, 0.0, 0.4505}, scene, true);
  Put("left", BoxModel({0.24, 0.03, 0.3}), {0.15, 0.145, 0.4505}, scene, true);
  Put("right", BoxModel({0.24, 0.03, 0.3}), {0.15, -0.145, 0.4505}, scene, true);
  Put("roof", BoxModel({0.3, 0.32, 0.03}), {0.15, 0.0, 0.6165}, scene, true);
  Put("door", BoxModel({0.05, 0.25, 0.25}, 1.0), {0.02, 0.0, 0.4255}, scene);
}

}  // namespace simwright::certificate
