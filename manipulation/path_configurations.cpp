#include "manipulation/path_configurations.h"

#include "manipulation/joint_target.h"
#include "manipulation/reach_plan.h"
#include "manipulation/tool_path.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;

constexpr int kSteps = 6;          // along the joint path
constexpr double kAtGrasp = 0.05;  // m from the grasp: a tool farther off is not at the grasp

}  // namespace

robot::JointVector PathConfigurations::At(double position) const {
  const bool rising = positions.back() > positions.front();
  size_t next = 0;
  while (next < positions.size() && (positions[next] < position) == rising) ++next;
  if (next == 0) return configurations.front();
  if (next == positions.size()) return configurations.back();
  const double share = (position - positions[next - 1]) / (positions[next] - positions[next - 1]);
  return configurations[next - 1] + share * (configurations[next] - configurations[next - 1]);
}

PathConfigurations ConfigurationsAlongJoint(const PlanningArm& context,
                                            const Interaction& interaction, tasks::WorldState state,
                                            const robot::JointVector& grasp_configuration,
                                            double pitch) {
  PathConfigurations along;
  if (!interaction.target || interaction.target->joint < 0) return along;
  const auto object = static_cast<size_t>(interaction.target->object);
  const auto joint = static_cast<size_t>(interaction.target->joint);
  double& position = state.joints[object][joint];
  const double begin = position;
  const double end = JointTarget(interaction.model.objects[object].joints[joint], begin);
  const Isometry3d tool = interaction.subtask.start.world_from_robot *
                          robot::ForwardKinematics(context.robot->arm, grasp_configuration);
  Eigen::Vector3d across = tool.linear().col(1);
  const Isometry3d target = GraspPose(interaction, state, across, pitch);
  if ((target.translation() - tool.translation()).norm() > kAtGrasp) return along;
  along.positions.push_back(begin);
  along.configurations.push_back(grasp_configuration);
  CartesianFollower follower(context, interaction, grasp_configuration);
  for (int i = 1; i <= kSteps; ++i) {
    position = begin + (end - begin) * i / kSteps;
    const Isometry3d next = GraspPose(interaction, state, across, pitch);
    across = next.linear().col(1);
    along.ends_early = !follower.MoveTo(next, OrientationTolerance(interaction));
    if (along.ends_early) break;
    along.positions.push_back(position);
    along.configurations.push_back(follower.configuration());
  }
  return along;
}

}  // namespace simwright::manipulation
