#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace simwright::workflows {

// Demonstrations with camera images, which the Python package records and writes.
struct ImageRecordingRequest {
  std::filesystem::path run;  // a folder written by TrainTask; empty: a shipped skill
  std::string skill;          // the shipped skill or long task; empty: the run's
  std::string format;         // lerobot, mcap or robomimic
  std::filesystem::path output;
  int episodes = 50;
  std::string cameras = "front,wrist";  // names with commas, or none
  int image_size = 128;                 // pixels a side
  std::string look = "none";            // none or wide: how looks are randomised
  std::string policy;              // expert or shipped; empty: the trained one, if there is one
  std::string keep = "successes";  // or all: failed episodes too
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  bool quiet = false, json = false;
};

// Returns the Python that has the package: SIMWRIGHT_PYTHON, else python3 of PATH. Throws
// core::Error, saying how to install the package, if there is none, if it has no package, or if its
// package has another version.
std::string PythonWithPackage();

// Returns the command that records `request` with `python`: `python -m simwright.demonstrations
// ...`.
std::vector<std::string> RecordingCommand(const std::string& python,
                                          const ImageRecordingRequest& request);

// Replaces this process with RecordingCommand(PythonWithPackage(), request), whose output, progress
// and exit code are then those of this program. Returns only by throwing core::Error.
[[noreturn]] void RecordWithPython(const ImageRecordingRequest& request);

}  // namespace simwright::workflows
