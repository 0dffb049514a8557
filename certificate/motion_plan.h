#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "certificate/clearance_margins.h"
#include "certificate/goal.h"
#include "certificate/grasp.h"
#include "certificate/placed_scene.h"
#include "robot/chain_kinematics.h"

namespace simwright::certificate {

class Planner;

enum class Phase { kReach, kApproach, kClose, kLift, kCarry, kLower, kOpen, kRetreat };
std::string PhaseName(Phase phase);

// A part of a motion: straight joint-space segments between waypoints, or the fingers' motion.
struct PlanSegment {
  Phase phase = Phase::kReach;
  std::vector<robot::JointVector> waypoints;  // (J) both ends included; one if the arm rests
  double leader = 0.0;                        // position of the gripper's first joint at its end
};

// A motion from the robot's home that grasps the target and brings it to its goal.
struct MotionPlan {
  Grasp grasp;
  std::vector<PlanSegment> segments;

  // Returns the length of the arm's path: the sum over its segments of the largest change of a
  // joint, rad or m.
  double Length() const;
};

struct MotionOptions {
  ClearanceMargins margins;
  int candidates = 96;     // most grasps that are tried with the whole arm
  int arm_solutions = 6;   // starts of the inverse kinematics per grasp
  double standoff = 0.1;   // m of the straight approach
  int tree_rounds = 250;   // most rounds of one search for a joint path
  int tree_searches = 12;  // most such searches that may fail for one target
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

// The counts of a search for plans of one target: the difficulty of the task, and its obstacles.
struct SearchCounts {
  int grasps = 0;            // antipodal grasps that fit into the gripper
  int gripper_rejected = 0;  // of these, the gripper hits an object at the grasp or before it
  int tried = 0;             // grasps tried with the whole arm
  int unreachable = 0;       // of these, without a configuration within the joint limits
  int arm_rejected = 0;      // of these, the arm hits an object
  int path_rejected = 0;     // of these, no collision-free approach, lift or carry
  int tree_searches = 0;     // searches for a joint path by RRT-Connect
  std::vector<int> hits;     // by body of the scene: rejections of grasps, configurations, paths
};

// Finds motion plans for one target, the most promising grasps first.
class MotionSearch {
 public:
  // All arguments must outlive the search. `start` (J): the robot's first configuration.
  MotionSearch(const Planner& planner, const PlacedScene& scene, int target, const Goal& goal,
               const Eigen::Isometry3d& world_from_robot, const MotionOptions& options);
  ~MotionSearch();

  // Returns the next plan; none when the candidates are exhausted. Throws core::Cancelled.
  std::optional<MotionPlan> Next();
  const SearchCounts& counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace simwright::certificate
