// Retimes motions recorded at 60 Hz for a controller at 1 kHz: the increase in duration, the
// deviation from the recording, the utilization of the limits, and the time it takes.
//   bench_retiming_table [MOTIONS=10]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "robot/limit_check.h"
#include "robot/panda_model.h"
#include "robot/retiming.h"
#include "tests/robot/recorded_motions.h"

namespace simwright::robot {
namespace {

void PrintRow(const RobotModel& model, const char* name, MotionKind kind, int motions) {
  const RetimedJoints joints = JointsToRetime(model);
  double stretch = 0.0, least = 0.0, longest = 0.0, turn = 0.0, tool = 0.0, seconds = 0.0,
         ratio = 0.0;
  int accepted = 0;
  for (int i = 0; i < motions; ++i) {
    const RecordedPath path = MakeMotion(model, kind, 10.0, static_cast<std::uint64_t>(i));
    const auto start = std::chrono::steady_clock::now();
    const Retimed retimed = Retime(path, joints.limits, joints.sliding, &model.arm);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const LimitReport report = CheckLimits(retimed.trajectory, joints.limits);
    accepted += report.accepted();
    for (const JointLimitReport& joint : report.joints) {
      ratio = std::max({ratio, joint.velocity.ratio, joint.acceleration.ratio, joint.jerk.ratio});
    }
    stretch += retimed.stretch / motions;
    least += LeastStretch(path, joints.limits) / motions;
    longest = std::max(longest, retimed.stretch);
    turn = std::max(turn, retimed.deviations.maxCoeff());
    tool = std::max(tool, retimed.tool_deviation);
  }
  std::printf("%-8s %-14s %3d/%-3d %6.2f %6.2f %6.2f %8.2f %7.2f %7.3f %8.2f\n", name,
              model.name.c_str(), accepted, motions, least, stretch, longest, 1e3 * turn,
              1e3 * tool, ratio, seconds / motions);
}

int Run(int motions) {
  std::printf(
      "10 s of motion at 60 Hz to 1 kHz; longer: times the recording;\n"
      "least: required by the velocity limits alone\n");
  std::printf("%-8s %-14s %-7s %6s %6s %6s %8s %7s %7s %8s\n", "motion", "robot", "passed", "least",
              "longer", "most", "mrad", "mm", "limits", "seconds");
  const std::pair<const char*, MotionKind> kinds[] = {{"smooth", MotionKind::kSmooth},
                                                      {"fast", MotionKind::kFast},
                                                      {"policy", MotionKind::kPolicy},
                                                      {"noisy", MotionKind::kNoisy},
                                                      {"corners", MotionKind::kCorners}};
  for (const auto& [name, kind] : kinds) {
    for (const bool on_base : {false, true}) PrintRow(Panda(on_base), name, kind, motions);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::robot

int main(int argc, char** argv) {
  try {
    return simwright::robot::Run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 10);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
