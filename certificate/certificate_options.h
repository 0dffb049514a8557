#pragma once

#include <string>

#include "certificate/grasp.h"
#include "certificate/motion_plan.h"
#include "certificate/motion_trajectory.h"
#include "certificate/proof.h"

namespace simwright::certificate {

struct CertificateOptions {
  MotionOptions motion;
  TrajectoryOptions trajectory;
  ProofOptions proof;
  int proofs = 4;           // most plans of one target that are replayed
  bool diagnose = true;     // find out what blocks a target
  int single_blockers = 8;  // most objects that are removed one by one
  int blocker_pairs = 6;    // most pairs that are removed together
  int most_removed = 10;    // most objects that are removed together

  bool IsValid(std::string* error) const;
};

}  // namespace simwright::certificate
