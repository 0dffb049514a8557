#include "manipulation/joint_path.h"

namespace simwright::manipulation {
namespace {

// Returns home with the base's joints and the first rotary joint as in `configuration`.
robot::JointVector Folded(const PlanningArm& context, const robot::JointVector& configuration) {
  robot::JointVector folded = context.robot->home();
  for (Eigen::Index j = 0; j < folded.size(); ++j) {
    folded[j] = configuration[j];
    if (!context.robot->arm.joints[static_cast<size_t>(j)].prismatic) break;
  }
  return folded;
}

}  // namespace

std::optional<JointPath> PlanSimplePath(const PlanningArm& context,
                                        const CollisionChecker& clearance,
                                        const robot::JointVector& from,
                                        const robot::JointVector& to) {
  const robot::JointVector here = Folded(context, from), there = Folded(context, to);
  const robot::JointVector& home = context.robot->home();
  for (const JointPath& joint_path :
       {JointPath{}, JointPath{here}, JointPath{there}, JointPath{here, there}, JointPath{home},
        JointPath{here, home}, JointPath{home, there}, JointPath{here, home, there}}) {
    robot::JointVector at = from;
    bool clear = true;
    for (const robot::JointVector& next : joint_path) {
      clear = clear && clearance.IsPathCollisionFree(at, next);
      at = next;
    }
    if (clear && clearance.IsPathCollisionFree(at, to)) return joint_path;
  }
  return std::nullopt;
}

}  // namespace simwright::manipulation
