#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/drop_test.h"

namespace simwright::sim {

// Returns the version of the loaded library, for example "2.2.2".
std::string MujocoVersion();

// A MuJoCo world to cross-check an asset: its MJCF file above the floor z = 0, beside any number of
// probe balls. One thread per world.
class MujocoWorld {
 public:
  // Loads `mjcf` (a file as assets::MjcfText writes it). `balls` are radii (m) of free spheres of
  // 1000 kg/m^3. Throws core::Error with MuJoCo's own message if the file does not compile.
  explicit MujocoWorld(const std::filesystem::path& mjcf, const std::vector<double>& balls = {});
  ~MujocoWorld();
  MujocoWorld(const MujocoWorld&) = delete;
  MujocoWorld& operator=(const MujocoWorld&) = delete;

  // Returns MuJoCo's own warnings from loading and stepping.
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

// Runs DropInBullet's experiment in MuJoCo.
DropResult DropInMujoco(const RigidBody& body, const std::filesystem::path& mjcf,
                        const DropOptions& options, std::vector<std::string>* warnings);

}  // namespace simwright::sim
