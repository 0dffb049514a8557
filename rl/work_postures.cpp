#include "rl/work_postures.h"

#include "rl/joint_work.h"
#include "rl/reach_plan.h"
#include "rl/tool_follower.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;

constexpr int kSteps = 6;          // along the joint path
constexpr double kAtGrasp = 0.05;  // m from the grasp: a tool farther off is not at the grasp

}  // namespace

robot::Posture WorkPostures::At(double position) const {
  const bool rising = positions.back() > positions.front();
  size_t next = 0;
  while (next < positions.size() && (positions[next] < position) == rising) ++next;
  if (next == 0) return postures.front();
  if (next == positions.size()) return postures.back();
  const double share = (position - positions[next - 1]) / (positions[next] - positions[next - 1]);
  return postures[next - 1] + share * (postures[next] - postures[next - 1]);
}

WorkPostures PosturesAlong(const Skill& skill, const SkillVariant& variant, tasks::SceneState state,
                           const robot::Posture& at_work, double pitch) {
  WorkPostures along;
  if (!variant.focus || variant.focus->joint < 0) return along;
  const auto thing = static_cast<size_t>(variant.focus->thing);
  const auto joint = static_cast<size_t>(variant.focus->joint);
  double& position = state.joints[thing][joint];
  const double begin = position;
  const double end = WorkEnd(variant.model.things[thing].joints[joint], begin);
  const Isometry3d tool =
      variant.subtask.start.world_from_robot * robot::ForwardKinematics(skill.robot->arm, at_work);
  Eigen::Vector3d across = tool.linear().col(1);
  const Isometry3d focus = ToolAtFocus(variant, state, across, pitch);
  if ((focus.translation() - tool.translation()).norm() > kAtGrasp) return along;
  along.positions.push_back(begin);
  along.postures.push_back(at_work);
  ToolFollower follower(skill, variant, at_work);
  for (int i = 1; i <= kSteps; ++i) {
    position = begin + (end - begin) * i / kSteps;
    const Isometry3d next = ToolAtFocus(variant, state, across, pitch);
    across = next.linear().col(1);
    along.ends_early = !follower.Goes(next, PushTurned(variant));
    if (along.ends_early) break;
    along.positions.push_back(position);
    along.postures.push_back(follower.posture());
  }
  return along;
}

}  // namespace simwright::rl
