#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace simwright::sim {

struct StabilityOptions {
  // The settling time (s) before the measurement. MuJoCo's contacts are springs of 5 ms and soft by
  // some micrometres: gaps of up to 0.1 mm between objects close in that time, and falling objects
  // are still detected.
  double settle = 0.25;
  double watch = 2.0;  // s

  bool IsValid(std::string* error) const;
};

// The motion of a body. Displacements are the largest of any of its points (MaxDisplacement).
struct BodyMotion {
  std::string name;
  double settled = 0.0;  // m, displacement from the pose in the file during `settle`
  double drift = 0.0;    // m, largest displacement during `watch`; HUGE_VAL: not finite
};

struct MujocoStability {
  std::vector<BodyMotion> bodies;     // bodies with a free joint, in the file's order
  std::vector<std::string> warnings;  // MuJoCo's own, from loading and stepping
  int contacts = 0, rows = 0;         // the largest numbers of contacts and constraints

  // Returns the body with the largest drift; null without bodies.
  const BodyMotion* Farthest() const;
};

// Checks the stability of the unchanged world of an MJCF file in MuJoCo. Throws core::Error with
// MuJoCo's own message if the file does not compile, and for invalid options.
MujocoStability CheckStabilityInMujoco(const std::filesystem::path& mjcf,
                                       const StabilityOptions& options = {});

}  // namespace simwright::sim
