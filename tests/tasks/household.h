#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "assets/primitive_meshes.h"
#include "assets/semantic_model.h"

namespace simwright::tasks {

// Objects made of boxes, with the dimensions that tests assume. The front faces -x, z is up, the
// floor is z = 0.

inline assets::UrdfShape Block(const Eigen::Vector3d& size, const Eigen::Vector3d& center) {
  assets::UrdfShape shape;
  shape.mesh = assets::BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(center)), &shape.mesh);
  return shape;
}

inline assets::UrdfLink MakeLink(const std::string& name, double mass) {
  assets::UrdfLink link;
  link.name = name;
  link.inertial = assets::Inertial{mass, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  return link;
}

inline assets::Joint MakeJoint(const std::string& name, const std::string& parent,
                               const std::string& child, assets::JointType type,
                               const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                               double lower, double upper) {
  assets::Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  joint.type = type;
  joint.parent_from_joint = Eigen::Translation3d(origin) * Eigen::Isometry3d::Identity();
  joint.axis = axis;
  joint.lower = lower;
  joint.upper = upper;
  return joint;
}

// Returns a microwave 0.4 deep, 0.5 wide and 0.3 high with walls of 2 cm, open to -x. A door is
// hinged at y = 0.25 with its handle at the other side; a button on the front above it moves 1 cm
// inwards.
inline assets::SemanticModel Microwave(const std::string& name = "microwave") {
  assets::SemanticModel asset;
  asset.name = name;
  asset.category = "microwave";
  assets::UrdfLink body = MakeLink("body", 12.0);
  body.collisions = {Block({0.4, 0.5, 0.02}, {0, 0, 0.01}), Block({0.4, 0.5, 0.02}, {0, 0, 0.29}),
                     Block({0.4, 0.02, 0.26}, {0, 0.24, 0.15}),
                     Block({0.4, 0.02, 0.26}, {0, -0.24, 0.15}),
                     Block({0.02, 0.46, 0.26}, {0.19, 0, 0.15})};
  assets::UrdfLink door = MakeLink("door", 2.0);
  door.collisions = {Block({0.02, 0.48, 0.26}, {-0.011, -0.25, 0})};
  assets::UrdfLink handle = MakeLink("handle", 0.1);
  handle.collisions = {Block({0.02, 0.02, 0.2}, {0, 0, 0})};
  assets::UrdfLink button = MakeLink("button", 0.02);
  button.collisions = {Block({0.01, 0.02, 0.02}, {0, 0, 0})};
  asset.model.links = {body, button, door, handle};
  asset.model.joints = {MakeJoint("button_joint", "body", "button", assets::JointType::kPrismatic,
                                  {-0.21, 0.2, 0.29}, {1, 0, 0}, 0.0, 0.01),
                        MakeJoint("door_joint", "body", "door", assets::JointType::kRevolute,
                                  {-0.2, 0.25, 0.15}, {0, 0, -1}, 0.0, 1.7),
                        MakeJoint("handle_joint", "door", "handle", assets::JointType::kFixed,
                                  {-0.06, -0.45, 0}, {1, 0, 0}, 0.0, 0.0)};
  asset.semantics = {{"door", {"hinge", "door"}},
                     {"handle", {"fixed", "handle"}},
                     {"button", {"slider", "button"}}};
  return asset;
}

// Returns a chest, 0.3 high, whose drawer slides 0.25 m towards -x.
inline assets::SemanticModel DrawerUnit(const std::string& name = "drawer_unit") {
  assets::SemanticModel asset;
  asset.name = name;
  asset.category = "drawer unit";
  assets::UrdfLink body = MakeLink("body", 8.0);
  body.collisions = {Block({0.4, 0.4, 0.02}, {0, 0, 0.01}), Block({0.4, 0.4, 0.02}, {0, 0, 0.29}),
                     Block({0.4, 0.02, 0.26}, {0, 0.19, 0.15}),
                     Block({0.4, 0.02, 0.26}, {0, -0.19, 0.15}),
                     Block({0.02, 0.36, 0.26}, {0.19, 0, 0.15})};
  assets::UrdfLink drawer = MakeLink("drawer", 2.0);
  drawer.collisions = {
      Block({0.34, 0.34, 0.01}, {0, 0, -0.115}), Block({0.01, 0.34, 0.2}, {-0.165, 0, -0.01}),
      Block({0.01, 0.34, 0.2}, {0.165, 0, -0.01}), Block({0.32, 0.01, 0.2}, {0, 0.165, -0.01}),
      Block({0.32, 0.01, 0.2}, {0, -0.165, -0.01})};
  assets::UrdfLink handle = MakeLink("handle", 0.1);
  handle.collisions = {Block({0.02, 0.12, 0.02}, {0, 0, 0})};
  asset.model.links = {body, drawer, handle};
  asset.model.joints = {MakeJoint("drawer_joint", "body", "drawer", assets::JointType::kPrismatic,
                                  {-0.02, 0, 0.15}, {-1, 0, 0}, 0.0, 0.25),
                        MakeJoint("handle_joint", "drawer", "handle", assets::JointType::kFixed,
                                  {-0.2, 0, 0}, {1, 0, 0}, 0.0, 0.0)};
  asset.semantics = {{"drawer", {"slider", "drawer"}}, {"handle", {"fixed", "handle"}}};
  return asset;
}

// Returns a chest 0.2 deep, 0.3 wide and 0.16 high, with a lid on a horizontal hinge at the back
// and a bar over the lid's front edge.
inline assets::SemanticModel Chest(const std::string& name = "chest") {
  assets::SemanticModel asset;
  asset.name = name;
  asset.category = "box";
  assets::UrdfLink body = MakeLink("body", 2.0);
  body.collisions = {
      Block({0.2, 0.3, 0.01}, {0, 0, 0.005}), Block({0.01, 0.3, 0.13}, {-0.095, 0, 0.075}),
      Block({0.01, 0.3, 0.13}, {0.095, 0, 0.075}), Block({0.18, 0.01, 0.13}, {0, 0.145, 0.075}),
      Block({0.18, 0.01, 0.13}, {0, -0.145, 0.075})};
  assets::UrdfLink lid = MakeLink("lid", 0.4);
  lid.collisions = {Block({0.2, 0.3, 0.01}, {-0.1, 0, 0.015})};
  assets::UrdfLink handle = MakeLink("handle", 0.05);
  handle.collisions = {Block({0.01, 0.11, 0.01}, {0, 0, 0.034}),
                       Block({0.008, 0.008, 0.029}, {0, 0.05, 0.0145}),
                       Block({0.008, 0.008, 0.029}, {0, -0.05, 0.0145})};
  asset.model.links = {body, lid, handle};
  asset.model.joints = {MakeJoint("lid_joint", "body", "lid", assets::JointType::kRevolute,
                                  {0.1, 0, 0.14}, {0, 1, 0}, 0.0, 1.5),
                        MakeJoint("handle_joint", "lid", "handle", assets::JointType::kFixed,
                                  {-0.155, 0, 0.02}, {1, 0, 0}, 0.0, 0.0)};
  asset.semantics = {{"lid", {"hinge", "lid"}}, {"handle", {"fixed", "handle"}}};
  return asset;
}

// Returns a cup of eight walls around a floor, open at the top.
inline assets::SemanticModel Cup(const std::string& name = "cup", double radius = 0.035,
                                 double height = 0.1) {
  assets::SemanticModel asset;
  asset.name = name;
  asset.category = "cup";
  assets::UrdfLink body = MakeLink("base", 0.2);
  const double wall = 0.1 * radius;
  body.collisions = {Block({1.4 * radius, 1.4 * radius, wall}, {0, 0, 0.5 * wall})};
  for (int i = 0; i < 8; ++i) {
    assets::UrdfShape side = Block({wall, 0.85 * radius, height}, {0, 0, 0.5 * height});
    core::Transform(
        Eigen::Affine3d(Eigen::AngleAxisd(i * std::numbers::pi / 4, Eigen::Vector3d::UnitZ()) *
                        Eigen::Translation3d(radius - 0.5 * wall, 0, 0)),
        &side.mesh);
    body.collisions.push_back(side);
  }
  asset.model.links = {body};
  return asset;
}

inline assets::SemanticModel Box(const std::string& name, const Eigen::Vector3d& size,
                                 double mass) {
  assets::SemanticModel asset;
  asset.name = name;
  asset.category = "box";
  assets::UrdfLink body = MakeLink("base", mass);
  body.collisions = {Block(size, {0, 0, 0.5 * size.z()})};
  asset.model.links = {body};
  return asset;
}

}  // namespace simwright::tasks
