#pragma once

#include <filesystem>
#include <string>
#include <vector>

struct mjModel_;
struct mjData_;

namespace simwright::sim {

// A compiled MJCF file of an asset above the floor z = 0, beside any number of probe balls. One
// thread per scene. MuJoCo's body 0 is the world, 1 is the asset's root.
class MujocoScene {
 public:
  // kOwn: the file is a complete world and is loaded unchanged, without balls.
  enum class Ground { kAdded, kOwn };

  // `balls` are radii (m) of free spheres of 1000 kg/m^3. `elements` are further elements of the
  // MJCF file, such as <asset> and <worldbody>. Both need Ground::kAdded. Throws core::Error with
  // MuJoCo's own message if the file does not compile.
  explicit MujocoScene(const std::filesystem::path& mjcf, const std::vector<double>& balls = {},
                       Ground ground = Ground::kAdded, const std::string& elements = "");
  ~MujocoScene();
  MujocoScene(const MujocoScene&) = delete;
  MujocoScene& operator=(const MujocoScene&) = delete;

  mjModel_* model() const { return model_; }
  mjData_* data() const { return data_; }
  // Returns MuJoCo's own warnings from loading and stepping.
  const std::vector<std::string>& warnings() const { return warnings_; }
  void Step();

 private:
  mjModel_* model_ = nullptr;
  mjData_* data_ = nullptr;
  std::vector<std::string> warnings_;
};

}  // namespace simwright::sim
