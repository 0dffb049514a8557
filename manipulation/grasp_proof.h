#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/progress.h"
#include "manipulation/grasp.h"
#include "manipulation/grasp_sampler.h"
#include "sim/grasp_trial.h"
#include "sim/gripper_model.h"

namespace simwright::manipulation {

struct GraspProofOptions {
  int count = 200;  // proved grasps at most
  // Candidates that are tried per wanted grasp, at most.
  int tries_per_grasp = 6;
  GraspSamplerOptions sampler;
  sim::GraspTrialOptions trial;  // its friction is replaced by that of object and fingers
  // Grasps are perturbed by this distance in a random direction and this angle about a random axis.
  double perturbation_distance = 0.005;        // m
  double perturbation_angle = 0.087266462599;  // rad, 5 degrees
  int perturbations = 8;                       // trials per grasp
  double perturbed_hold_time = 0.3;            // s; those are not shaken
  double least_quality = 0.5;                  // of a proved grasp
  // The share of the trial's limits on slip and turn that a grasp may use in Bullet, where it is
  // chosen: others hold by chance, and not in another engine.
  double margin_share = 0.6;

  bool IsValid(std::string* error) const;
};

struct ProvedGrasps {
  std::vector<Grasp> grasps;            // best quality first
  GraspSampling sampling;               // its grasps are the candidates
  double friction = 0.0;                // of the pair of object and finger, in the trials
  int tried = 0;                        // candidates in Bullet
  int held_in_bullet = 0;               // of these, with the least quality
  int held_in_both = 0;                 // and in MuJoCo
  double coverage = 0.0;                // GraspCoverage of the candidates
  std::map<std::string, int> failures;  // reasons in Bullet, without their figures

  // Returns the share of the grasps proved in Bullet that hold in MuJoCo; 0 without any.
  double EngineAgreement() const;
  // Returns one sentence on why none is proved; empty if some are.
  std::string WhyNone(const sim::GripperModel& gripper) const;
};

// Samples grasps of an object and keeps those that hold in Bullet and in MuJoCo, a diverse choice
// of at most options.count. A part of an articulated body (GraspObject::part) holds if the gripper
// moves its joint. Deterministic in `seed`, for any number of threads. Throws core::Error, saying
// why, if a rigid object cannot be grasped: it is too heavy, too wide, too thin, or the gripper
// collides; a part then has no grasps. `progress` counts the proved grasps; may be null.
ProvedGrasps ProveGrasps(const GraspObject& object, const sim::GripperModel& gripper,
                         const GraspProofOptions& options, std::uint64_t seed,
                         core::Progress* progress = nullptr);

}  // namespace simwright::manipulation
