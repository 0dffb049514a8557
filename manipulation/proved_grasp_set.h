#pragma once

#include <string>
#include <vector>

#include "manipulation/grasp_file.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/handle.h"

namespace simwright::manipulation {

// Returns the set of a rigid object from its proof. `mesh`: GraspSet::mesh.
GraspSet MakeGraspSet(const GraspObject& object, const std::string& mesh,
                      const ParallelGripper& gripper, const ProvedGrasps& proved);
// Returns the set of an articulated asset from its handles and their proofs. (handles) `urdf`: its
// file.
GraspSet MakeGraspSet(const std::string& name, const std::string& urdf,
                      const ParallelGripper& gripper, const std::vector<Handle>& handles,
                      const std::vector<ProvedGrasps>& proofs);

}  // namespace simwright::manipulation
