// Trajectory files from anywhere, in each format: core::Error, or a whole trajectory that reads
// back as the same; nothing else.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "robot/trajectory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace simwright::robot;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const TrajectoryFormat format :
       {TrajectoryFormat::kRosYaml, TrajectoryFormat::kRosJson, TrajectoryFormat::kCsv}) {
    JointTrajectory read;
    std::string written;
    try {
      read = ParseTrajectory(text, format, "file");
      RequireWellFormed(read, "file");
      written = TrajectoryText(read, format);
    } catch (const simwright::core::Error&) {
      continue;  // no trajectory, or one with names that are not written
    }
    const JointTrajectory again = ParseTrajectory(written, format, "file");
    if (again.times != read.times || again.positions != read.positions ||
        again.joints != read.joints) {
      std::abort();
    }
  }
  return 0;
}
