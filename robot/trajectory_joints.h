#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// The motion of `joints` alone, in their order, with the same times and notes. Throws core::Error
// where the trajectory lacks one.
JointTrajectory JointsOf(const JointTrajectory& trajectory, const std::vector<std::string>& joints);

// One motion of the joints of both, with the notes of `first`. Throws core::Error, naming `where`,
// where their times differ or a joint is in both.
JointTrajectory Joined(const JointTrajectory& first, const JointTrajectory& second,
                       const std::string& where);

// The same motion under other names (old to new); joints that are not in `names` keep theirs.
JointTrajectory Renamed(const JointTrajectory& trajectory,
                        const std::map<std::string, std::string>& names);

}  // namespace simwright::robot
