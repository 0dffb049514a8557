#include "certificate/certificate.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "certificate/diagnosis.h"
#include "core/error.h"
#include "robot/trajectory_file.h"

namespace simwright::certificate {
namespace {

// Writes the trajectory and reads it back.
robot::JointTrajectory ThroughFile(const robot::JointTrajectory& trajectory,
                                   const std::filesystem::path& file) {
  if (file.empty()) {
    constexpr auto kFormat = robot::TrajectoryFormat::kRosJson;
    return robot::ParseTrajectory(robot::TrajectoryText(trajectory, kFormat), kFormat,
                                  "the planned trajectory");
  }
  robot::WriteTrajectory(file, trajectory);
  return robot::ReadTrajectory(file);
}

void RequireTargets(const PlacedScene& scene, const std::vector<TargetTask>& targets) {
  if (targets.empty()) throw core::Error("there is no target to certify", "certificate");
  for (const TargetTask& task : targets) {
    if (task.target < 0 || static_cast<size_t>(task.target) >= scene.bodies.size()) {
      throw core::Error("there is no body " + std::to_string(task.target) + " in the scene",
                        "certificate");
    }
    if (scene.bodies[static_cast<size_t>(task.target)].fixed) {
      throw core::Error("furniture cannot be brought anywhere",
                        scene.bodies[static_cast<size_t>(task.target)].name);
    }
  }
}

// Returns the moments that pictures show: before the motion, at the grasp, and at the end.
std::vector<double> PictureTimes(const TimedMotion& motion) {
  std::vector<double> times = {0.0};
  for (const PhaseTime& phase : motion.phases) {
    if (phase.phase == Phase::kClose) times.push_back(phase.end);
  }
  times.push_back(motion.trajectory.times.back());
  return times;
}

}  // namespace

Certificate CertifyTarget(const Planner& planner, const PlacedScene& scene, const TargetTask& task,
                          const CertificateOptions& options, const std::filesystem::path& file) {
  Certificate certificate;
  certificate.target = task.target;
  if (!task.goal) {
    certificate.verdict = Verdict::kNoPlace;
    certificate.reason = "no free place at the goal";
    return certificate;
  }
  ++certificate.searches;
  MotionSearch search(planner, scene, task.target, *task.goal, task.world_from_robot,
                      options.motion);
  certificate.verdict = Verdict::kBlocked;
  while (certificate.proofs < options.proofs) {
    std::optional<MotionPlan> plan = search.Next();
    certificate.counts = search.counts();
    if (!plan) break;
    ++certificate.proofs;
    certificate.verdict = Verdict::kFailsInSimulation;
    certificate.plan = std::move(plan);
    TimedMotion motion;
    try {
      motion = TrajectoryOf(*certificate.plan, planner.robot(), options.trajectory);
    } catch (const core::Error& error) {
      certificate.proof = {};
      certificate.proof.failure = "cannot be timed within the robot's limits";
      continue;
    }
    const robot::JointTrajectory trajectory = ThroughFile(motion.trajectory, file);
    certificate.phases = motion.phases;
    certificate.proof = Replay(planner, scene, task.target, *task.goal, task.world_from_robot,
                               trajectory, PictureTimes(motion), options.proof);
    if (!certificate.proof.success) continue;
    certificate.verdict = Verdict::kSolvable;
    certificate.trajectory = trajectory;
    return certificate;
  }
  if (!file.empty()) std::filesystem::remove(file);
  if (certificate.verdict == Verdict::kFailsInSimulation) {
    certificate.reason = "fails in simulation: the robot " + certificate.proof.failure;
  }
  return certificate;
}

bool CertificateOptions::IsValid(std::string* error) const {
  if (!motion.IsValid(error) || !trajectory.IsValid(error) || !proof.IsValid(error)) return false;
  const bool valid = proofs >= 1 && proofs <= 1000 && single_blockers >= 0 && blocker_pairs >= 0 &&
                     most_removed >= 0;
  if (!valid && error != nullptr) *error = "a certificate needs at least one proof";
  return valid;
}

std::string VerdictName(Verdict verdict) {
  constexpr std::array kNames = {"solvable", "unreachable",         "no-collision-free-grasp",
                                 "blocked",  "fails-in-simulation", "no-free-place"};
  return kNames[static_cast<size_t>(verdict)];
}

double Certificate::Difficulty() const {
  if (!solvable() || counts.grasps == 0) return 1.0;
  return static_cast<double>(counts.gripper_rejected + counts.tried - 1) / counts.grasps;
}

Certificate Certify(const Planner& planner, const PlacedScene& scene,
                    const std::vector<TargetTask>& targets, const CertificateOptions& options,
                    const std::filesystem::path& file) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "certificate");
  RequireTargets(scene, targets);
  std::vector<Certificate> failed;
  int searches = 0;
  for (const TargetTask& task : targets) {
    Certificate certificate = CertifyTarget(planner, scene, task, options, file);
    searches += certificate.searches;
    certificate.searches = searches;
    if (certificate.solvable()) return certificate;
    failed.push_back(std::move(certificate));
  }
  size_t best = 0;
  for (size_t i = 0; i < failed.size() && options.diagnose; ++i) {
    Certificate& certificate = failed[i];
    if (certificate.verdict != Verdict::kBlocked) continue;
    certificate.searches = 0;
    Diagnose(planner, scene, targets[i], options, &certificate);
    searches += certificate.searches;
    best = i;
    if (certificate.blockers_verified) break;
  }
  // A verified blocker says most, then any other reason of the easiest target.
  if (!failed[best].blockers_verified) {
    const auto rank = [](const Certificate& one) {
      if (one.verdict == Verdict::kBlocked) return one.blockers.empty() ? 1 : 0;
      return one.verdict == Verdict::kFailsInSimulation ? 2 : 3;
    };
    for (size_t i = 0; i < failed.size(); ++i) {
      if (rank(failed[i]) < rank(failed[best])) best = i;
    }
  }
  failed[best].searches = searches;
  return failed[best];
}

std::optional<double> PlannedDifficulty(const Planner& planner, const PlacedScene& scene,
                                        const std::vector<TargetTask>& targets,
                                        const CertificateOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "certificate");
  RequireTargets(scene, targets);
  for (const TargetTask& task : targets) {
    if (!task.goal) continue;
    MotionSearch search(planner, scene, task.target, *task.goal, task.world_from_robot,
                        options.motion);
    if (!search.Next()) continue;
    Certificate planned;
    planned.verdict = Verdict::kSolvable;
    planned.counts = search.counts();
    return planned.Difficulty();
  }
  return std::nullopt;
}

std::vector<TargetTask> EasiestFirst(const Planner& planner, const PlacedScene& scene,
                                     std::vector<TargetTask> targets) {
  struct Ranked {
    bool graspless;
    int between;
    double distance;
    TargetTask task;
  };
  std::vector<Ranked> ranked;
  for (TargetTask& task : targets) {
    const PlacedBody& body = scene.bodies[static_cast<size_t>(task.target)];
    const Eigen::AlignedBox3d box = BoundsOf(body);
    Ranked one{planner.GraspsOf(body.model).empty(), 0, 0.0, task};
    Eigen::AlignedBox3d corridor = box;
    corridor.extend(Eigen::Vector3d(task.world_from_robot.translation().x(), box.center().y(),
                                    box.center().z()));
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      const bool other = static_cast<int>(i) != task.target && !scene.bodies[i].fixed;
      one.between += other && corridor.intersects(BoundsOf(scene.bodies[i]));
    }
    one.distance = (box.center() - task.world_from_robot.translation()).norm();
    ranked.push_back(std::move(one));
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::tie(a.graspless, a.between, a.distance) <
           std::tie(b.graspless, b.between, b.distance);
  });
  std::vector<TargetTask> sorted;
  for (Ranked& one : ranked) sorted.push_back(std::move(one.task));
  return sorted;
}

}  // namespace simwright::certificate
