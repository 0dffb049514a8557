#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/drop_test.h"

namespace simwright::sim {

// The version of the library that is loaded, "2.2.2".
std::string MujocoVersion();

// MuJoCo as the second opinion on an asset: its MJCF file over the floor z = 0, beside any number
// of probe balls. One thread a world.
class MujocoWorld {
 public:
  // Loads `mjcf` (a file as assets::MjcfText writes it). `balls` are radii (m) of free spheres of
  // 1000 kg/m^3. Throws core::Error with MuJoCo's own words where the file does not compile.
  explicit MujocoWorld(const std::filesystem::path& mjcf, const std::vector<double>& balls = {});
  ~MujocoWorld();
  MujocoWorld(const MujocoWorld&) = delete;
  MujocoWorld& operator=(const MujocoWorld&) = delete;

  // What MuJoCo warned of while loading and stepping, in its own words.
  const std::vector<std::string>& warnings() const;

  // Body 0 is the asset, 1 ... are the balls.
  void SetPose(int body, const Eigen::Isometry3d& world_from_body);
  void Step();
  double time() const;
  Eigen::Isometry3d Pose(int body) const;  // world_from_body
  assets::Inertial LoadedInertial(int body) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

// DropInBullet's experiment in MuJoCo.
DropResult DropInMujoco(const RigidBody& body, const std::filesystem::path& mjcf,
                        const DropOptions& options, std::vector<std::string>* warnings);

}  // namespace simwright::sim
