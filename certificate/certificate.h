#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate_options.h"
#include "certificate/goal.h"
#include "certificate/motion_plan.h"
#include "certificate/motion_trajectory.h"
#include "certificate/placed_scene.h"
#include "certificate/planner.h"
#include "certificate/proof.h"

namespace simwright::certificate {

// A target for the task: any of several targets may do.
struct TargetTask {
  int target = -1;           // a body of the scene
  std::optional<Goal> goal;  // none: there is no free place for it
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
};

enum class Verdict {
  kSolvable,           // a plan is proved by its replay
  kUnreachable,        // no configuration reaches a grasp, even without other objects
  kNoGrasp,            // no grasp fits, or furniture is in the way of all of them
  kBlocked,            // free objects are in the way
  kFailsInSimulation,  // there are plans, but no replay succeeds
  kNoPlace             // no free place at the goal
};
std::string VerdictName(Verdict verdict);  // "solvable", "unreachable", ...

struct Certificate {
  Verdict verdict = Verdict::kNoPlace;
  std::string reason;              // in words; empty if solvable
  int target = -1;                 // the body that is brought, or that was examined
  std::optional<MotionPlan> plan;  // the proved one, or the last one that failed
  std::vector<PhaseTime> phases;
  Proof proof;                        // of `plan`
  robot::JointTrajectory trajectory;  // the proved one, as read back from its file
  SearchCounts counts;                // of the target
  int proofs = 0;                     // replays of plans of the target
  std::vector<std::string> blockers;  // kBlocked: removing them opens a way
  bool blockers_verified = false;     // the scene without them is certified, replay included
  int searches = 0;                   // searches for plans, of all targets and diagnoses

  bool solvable() const { return verdict == Verdict::kSolvable; }
  // Returns the difficulty of a solvable task: the share of the target's grasps, those that fit
  // into the gripper, that were rejected before the first that works, 0 to 1. 1 if it is not
  // solvable.
  double Difficulty() const;
};

// Decides whether the robot can bring one of `targets` to its goal without moving other objects, in
// the order of the list, and proves it: the trajectory of a plan is written to `file`, read back,
// and replayed in a fresh Bullet world (Replay). The file is removed if no replay succeeds; without
// a file name the trajectory passes through the text of the file. If no target is solvable, states
// the reason for the first one for which it can be found. Depends on nothing but its arguments, and
// can run in parallel with one planner. Throws core::Error for invalid options or no targets,
// core::Cancelled.
Certificate Certify(const Planner& planner, const PlacedScene& scene,
                    const std::vector<TargetTask>& targets, const CertificateOptions& options = {},
                    const std::filesystem::path& file = {});

// Returns the difficulty of the task (Certificate::Difficulty) if there is a plan for one of the
// targets, none otherwise. Plans only, without retiming and physics: the filter for a search over
// scenes, of which Certify then proves the results.
std::optional<double> PlannedDifficulty(const Planner& planner, const PlacedScene& scene,
                                        const std::vector<TargetTask>& targets,
                                        const CertificateOptions& options = {});

// Returns the targets ordered by how accessible they are: those with grasps first, then by the
// number of free bodies between them and the robot, then by distance from the robot.
std::vector<TargetTask> EasiestFirst(const Planner& planner, const PlacedScene& scene,
                                     std::vector<TargetTask> targets);

}  // namespace simwright::certificate
