// Measures inverse kinematics to a full pose: the share of random reachable poses that are solved
// from the home configuration, and the time of solving and tracking on one core.
//   bench_ik_speed [POSES=10000]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "robot/panda_model.h"
#include "robot/pose_inverse_kinematics.h"

namespace simwright::robot {
namespace {

using Clock = std::chrono::steady_clock;

double Microseconds(Clock::time_point since) {
  return std::chrono::duration<double, std::micro>(Clock::now() - since).count();
}

JointVector RandomPosture(const Arm& arm, core::Rng& rng) {
  JointVector q(arm.size());
  for (int j = 0; j < arm.size(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    q[j] = core::Uniform(rng, joint.lower, joint.upper);
  }
  return q;
}

struct Times {
  std::vector<double> all;
  double mean() const {
    double sum = 0.0;
    for (const double time : all) sum += time;
    return sum / static_cast<double>(all.size());
  }
  double quantile(double share) {
    std::sort(all.begin(), all.end());
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  }
};

void PrintSolve(const RobotModel& model, int poses) {
  const PoseInverseKinematics solver(model.arm);
  core::Rng rng(1);
  Times times;
  int reached = 0, starts = 0, iterations = 0;
  for (int i = 0; i < poses; ++i) {
    const Eigen::Isometry3d target = ForwardKinematics(model.arm, RandomPosture(model.arm, rng));
    const JointVector home = model.home();
    const Clock::time_point start = Clock::now();
    const PoseSolution solution = solver.Solve(target, home, rng);
    times.all.push_back(Microseconds(start));
    reached += solution.reached;
    starts += solution.starts;
    iterations += solution.iterations;
  }
  std::printf("%-14s solve  %6.2f %%  %6.1f %6.1f %6.1f %7.1f   %.2f starts, %.1f iterations\n",
              model.name.c_str(), 100.0 * reached / poses, times.mean(), times.quantile(0.5),
              times.quantile(0.99), times.quantile(1.0), 1.0 * starts / poses,
              1.0 * iterations / poses);
}

// Tracks a circle of 10 cm with the tool in 2 s at 60 Hz.
void PrintTrack(const RobotModel& model, int poses) {
  const PoseInverseKinematics solver(model.arm);
  const JointVector longest = JointVector::Constant(model.arm.size(), 2.0 / 60.0);
  JointVector q = model.home();
  const Eigen::Isometry3d home = ForwardKinematics(model.arm, model.home());
  Times times;
  int within = 0;
  for (int i = 0; i < poses; ++i) {
    const double angle = std::numbers::pi * i / 60.0;
    Eigen::Isometry3d target = home;
    target.translation() += 0.1 * Eigen::Vector3d(0, std::sin(angle), 1.0 - std::cos(angle));
    const Clock::time_point start = Clock::now();
    const PoseError error = solver.Track(target, longest, &q);
    times.all.push_back(Microseconds(start));
    within += error.position < 1e-3 && error.angle < 0.5 * std::numbers::pi / 180;
  }
  std::printf("%-14s track  %6.2f %%  %6.1f %6.1f %6.1f %7.1f\n", model.name.c_str(),
              100.0 * within / poses, times.mean(), times.quantile(0.5), times.quantile(0.99),
              times.quantile(1.0));
}

int Run(int poses) {
  std::printf("%d poses; within 1 mm and 0.5 degrees; microseconds\n", poses);
  std::printf("%-14s        %8s  %6s %6s %6s %7s\n", "robot", "found", "mean", "p50", "p99",
              "most");
  const RobotModel generic =
      ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots/generic6/generic6.urdf");
  for (const RobotModel* model : {&Panda(false), &Panda(true), &generic}) {
    PrintSolve(*model, poses);
    PrintTrack(*model, poses);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::robot

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 10000;
  if (poses < 1) {
    std::fprintf(stderr, "usage: bench_ik_speed [POSES]\n");
    return 2;
  }
  return simwright::robot::Run(poses);
}
