#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// Returns the trajectory of `joints` only, in their order, with the same times and metadata. Throws
// core::Error if the trajectory lacks one.
JointTrajectory JointsOf(const JointTrajectory& trajectory, const std::vector<std::string>& joints);

// Returns one trajectory with the joints of both and the metadata of `first`. Throws core::Error,
// naming `where`, if the times differ or a joint is in both.
JointTrajectory Joined(const JointTrajectory& first, const JointTrajectory& second,
                       const std::string& where);

// Returns the trajectory with renamed joints (old name to new name); joints that are not in `names`
// keep theirs.
JointTrajectory Renamed(const JointTrajectory& trajectory,
                        const std::map<std::string, std::string>& names);

}  // namespace simwright::robot
