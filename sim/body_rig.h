#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

// A free box beside the body of a BodyRig. Between box and body the body's friction applies.
struct RigBox {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();                    // m, edges
  double mass = 0.0;                                                 // kg
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();  // origin at its centre
};

// The test rig for experiments with one free rigid body, and boxes, above the floor z = 0 in a
// physics engine. One thread per rig.
class BodyRig {
 public:
  virtual ~BodyRig() = default;

  // Sets gravity (m/s^2, world) from the next step on.
  virtual void SetGravity(const Eigen::Vector3d& gravity) = 0;
  virtual void Step() = 0;
  virtual double time() const = 0;       // s
  virtual double time_step() const = 0;  // s
  // Returns world_from_body of the body (0) or of a box (1 ...).
  virtual Eigen::Isometry3d Pose(int index) const = 0;
  virtual double DeepestPenetration() const = 0;          // m, over all contacts of the last step
  virtual std::vector<std::string> Warnings() const = 0;  // the engine's own
};

// Creates a rig in Bullet (World, 240 Hz).
std::unique_ptr<BodyRig> BulletBodyRig(const RigidBody& body,
                                       const Eigen::Isometry3d& world_from_body,
                                       const std::vector<RigBox>& boxes = {});

// Creates a rig in MuJoCo from the body's MJCF file (as assets::MjcfText writes it). Throws
// core::Error with MuJoCo's own message if the file does not compile.
std::unique_ptr<BodyRig> MujocoBodyRig(const std::filesystem::path& mjcf, const RigidBody& body,
                                       const Eigen::Isometry3d& world_from_body,
                                       const std::vector<RigBox>& boxes = {});

// Creates a rig of one of the engines.
using BodyRigFactory = std::function<std::unique_ptr<BodyRig>(
    const Eigen::Isometry3d& world_from_body, const std::vector<RigBox>& boxes)>;

}  // namespace simwright::sim
