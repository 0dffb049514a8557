#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace simwright::sim {

struct StillnessOptions {
  // s before the watch. MuJoCo's contacts are springs of 5 ms and soft by some micrometres: what a
  // scene leaves between things, up to 0.1 mm, closes in that time; nothing that falls is missed.
  double settle = 0.25;
  double watch = 2.0;  // s

  bool IsValid(std::string* error) const;
};

// A point's way is that of its centre of mass, and of the body's farthest vertex as it turns.
struct BodyMotion {
  std::string name;
  double settled = 0.0;  // m from where the file has it to where it was after `settle`
  double drift = 0.0;  // m, the farthest it was from there while it was watched; HUGE_VAL: nowhere
};

struct MujocoStillness {
  std::vector<BodyMotion> bodies;     // what has a free joint, in the file's order
  std::vector<std::string> warnings;  // MuJoCo's own, while loading and stepping
  int contacts = 0, rows = 0;         // the most that there were at once, of constraints too

  // The body that drifted most; null without any.
  const BodyMotion* Farthest() const;
};

// Runs the world of an MJCF file, as it is, in MuJoCo. Throws core::Error in MuJoCo's own words
// where it does not compile, and for options that are not valid.
MujocoStillness WatchInMujoco(const std::filesystem::path& mjcf,
                              const StillnessOptions& options = {});

}  // namespace simwright::sim
