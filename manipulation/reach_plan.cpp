#include "manipulation/reach_plan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "manipulation/collision_checker.h"
#include "manipulation/goal_displacement.h"
#include "manipulation/grasp_ranking.h"
#include "manipulation/ik_solutions.h"
#include "manipulation/joint_target.h"
#include "manipulation/link_pose.h"
#include "manipulation/tool_path.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kFingerDistance = 0.03;  // m behind a pushed object: fingers lean, walls lean out
// The distance (m) to its goal below which an object is pushed on as before: otherwise the gripper
// would have to go around the object whenever it has passed its goal.
constexpr double kNearGoal = 0.03;
constexpr double kPitches[] = {0.0, 0.35, -0.35, 0.7, -0.7};
// The pitches for pushing an object: a gripper that leans back has its palm behind the object, so
// that the fingers push below the middle. Upright, the palm would come down on an object that is
// taller than the fingers are long.
constexpr double kPushPitches[] = {0.6, 0.8, 0.4};
// The pitches for pushing a door shut, which is taller than the fingers are long.
constexpr double kShutPitches[] = {0.3, 0.6, 0.0, 0.9};
// The pitches in a side-opening receptacle: palm and flange stay out of it, or below its ceiling. A
// microwave is 20 cm high inside; upright, gripper and flange alone are 25 cm.
constexpr double kRoomPitches[] = {0.8, 1.0, 0.6, 1.2};
// The orientation tolerance (rad) of fingers that push a wide open door shut: most wrists cannot
// rotate with it all the way.
constexpr double kPushTurned = 0.6;
constexpr double kLeanShare = 0.9;  // share of the lean that must point into the receptacle
// The number of candidates in receptacles and along a joint path: a collision check takes a
// millisecond.
constexpr int kMostCandidates = 6;
// The rise per metre of the path over a rim: about the reach of the fingers into a cup over its
// width.
constexpr double kRise = 1.0;
constexpr double kPalmEdge = 0.04;        // m: the palm edge's drop over 1 - cos(lean)
constexpr double kPalmClearance = 0.003;  // m, of a leaning gripper above the rim of a cup
constexpr double kReachTurns[] = {0.25 * M_PI, 0.5 * M_PI, 0.75 * M_PI};  // of the closing axis
constexpr double kSameLine = 0.97;  // the cosine of about 14 degrees

// Returns the positions from the joint's current one to the joint target.
std::vector<double> PositionsAlongJoint(const tasks::ObjectJoint& joint, double position) {
  const double end = JointTarget(joint, position);
  std::vector<double> positions;
  for (int i = 1; i <= 6; ++i) positions.push_back(position + (end - position) * i / 6.0);
  return positions;
}

// An orientation of the gripper at its target.
struct GraspOrientation {
  Vector3d across;  // unit, world: the tool's y axis
  double pitch = 0.0;
  int grasp = -1;  // ReachPlan::grasp
};

// The requirements of a plan.
struct Requirements {
  bool looks_ahead = false;  // the object can be carried on to interaction.next
  bool leans_in = false;     // the gripper leans into interaction.room
  bool clear = false;        // ReachPlan::clear
  bool round = false;        // or ReachPlan::via
  double margin = 0.0;       // m, PathOptions
  bool half = false;         // only the first half of the joint path, with the larger tolerance
};

// Returns true if the tool reaches `there` in interaction.room through its opening with a
// collision-free arm.
bool EntersReceptacle(const PlanningArm& context, const Interaction& interaction,
                      const tasks::WorldState& state, const Isometry3d& there,
                      CartesianFollower* follower) {
  Isometry3d before = there;
  before.translation() += DisplacementOutOfReceptacle(interaction, state, there.translation());
  for (const Isometry3d& place : {before, there}) {
    if (!follower->MoveTo(place)) return false;
    const robot::JointVector& arm = follower->configuration();
    if (!IsArmCollisionFree(context, interaction, state, arm, interaction.target->object))
      return false;
  }
  return true;
}

// Returns true if an object grasped at `tool` can be carried to its destinations.
bool CanCarry(const PlanningArm& context, const Interaction& interaction,
              const tasks::WorldState& state, const Isometry3d& tool,
              const Requirements& requirements, CartesianFollower* follower) {
  const auto goes = [&](const Destination& destination) {
    Isometry3d there = tool;
    there.translation() += DisplacementTo(destination, interaction, state);
    if (destination.room) return EntersReceptacle(context, interaction, state, there, follower);
    return follower->MoveTo(there);
  };
  const bool inside =
      interaction.room && IsIn(*interaction.room, interaction.model, state, tool.translation());
  if (inside && !EntersReceptacle(context, interaction, state, tool, follower)) return false;
  if (interaction.destination && !goes(*interaction.destination)) return false;
  return !requirements.looks_ahead || !interaction.next || goes(*interaction.next);
}

// A configuration with the tool at the target.
struct Candidate {
  Isometry3d tool;  // world_from_tool
  double pitch = 0.0;
  int grasp = -1;
  robot::JointVector configuration;
  double seconds = 0.0;  // to reach it, every joint at its highest speed
};

// Returns the movable objects in a sliding part of the target's object: those whose middles are in
// its AABB.
std::vector<size_t> ObjectsInPart(const Interaction& interaction, const tasks::WorldState& state) {
  const InteractionTarget& target = *interaction.target;
  const tasks::ObjectJoint& joint = interaction.model.objects[static_cast<size_t>(target.object)]
                                        .joints[static_cast<size_t>(target.joint)];
  std::vector<size_t> inside;
  if (joint.type != reward::RewardJointType::kPrismatic) return inside;
  const Eigen::AlignedBox3d part =
      tasks::WorldAabb(interaction.model, state, target.object, joint.link);
  for (const tasks::AssetPlacement& placement : interaction.subtask.start.placements) {
    const int object = interaction.model.Find(placement.asset);
    if (object == target.object || placement.fixed) continue;
    const Vector3d middle = tasks::WorldAabb(interaction.model, state, object).center();
    if (part.contains(middle)) inside.push_back(static_cast<size_t>(object));
  }
  return inside;
}

// Moves the target's joint to `position` (rad or m), and `carried` with its part.
void MovePart(const Interaction& interaction, double position, const std::vector<size_t>& carried,
              tasks::WorldState* state) {
  const InteractionTarget& target = *interaction.target;
  const auto object = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
  const int link = interaction.model.objects[object].joints[j].link;
  const Isometry3d before = WorldFromLink(interaction.model, *state, target.object, link);
  state->joints[object][j] = position;
  const Isometry3d after = WorldFromLink(interaction.model, *state, target.object, link);
  for (const size_t other : carried) {
    state->roots[other] = after * before.inverse() * state->roots[other];
  }
}

// Returns true if the tool can follow the joint path and, if required, the arm except its fingers
// is collision-free.
bool MovesJoint(const PlanningArm& context, const Interaction& interaction, tasks::WorldState state,
                const Candidate& candidate, const Requirements& requirements,
                CartesianFollower* follower) {
  const InteractionTarget& target = *interaction.target;
  const auto object = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
  Vector3d across = candidate.tool.linear().col(1);
  const std::vector<double> positions =
      PositionsAlongJoint(interaction.model.objects[object].joints[j], state.joints[object][j]);
  const size_t followed = requirements.half ? positions.size() / 2 : positions.size();
  const double turned =
      requirements.half ? OrientationTolerance(interaction) : CartesianFollower::kTurned;
  const std::vector<size_t> carried = ObjectsInPart(interaction, state);
  for (size_t i = 0; i < followed; ++i) {
    MovePart(interaction, positions[i], carried, &state);
    const Isometry3d next = GraspPose(interaction, state, across, candidate.pitch);
    across = next.linear().col(1);
    if (!follower->MoveTo(next, turned)) return false;
    if (!requirements.clear) continue;
    const CollisionChecker clearance(context, interaction, state);
    if (!clearance.IsCollisionFree(follower->configuration(), Fingers::kIgnored)) return false;
  }
  return true;
}

void AddCandidates(const PlanningArm& context, const Interaction& interaction,
                   const tasks::WorldState& state, const GraspOrientation& orientation,
                   const robot::JointVector& from, core::Rng& rng,
                   std::vector<Candidate>* candidates) {
  const Isometry3d tool =
      GraspPose(interaction, state, orientation.across, orientation.pitch, orientation.grasp);
  for (const IkSolution& found : SolveIkFromManyStarts(context, interaction, tool, from, rng)) {
    candidates->push_back(
        {tool, orientation.pitch, orientation.grasp, found.configuration, found.seconds});
  }
}

// Returns the pushing pose: x along the displacement to the destination, z down, the origin behind
// the object.
Isometry3d PushingPose(const Interaction& interaction, const tasks::WorldState& state,
                       const Vector3d& across) {
  const auto object = static_cast<size_t>(interaction.target->object);
  const Vector3d down = -Vector3d::UnitZ();
  Vector3d displacement = DisplacementToDestination(interaction, state);
  displacement.z() = 0.0;
  const Vector3d along =
      displacement.norm() > kNearGoal ? displacement.normalized() : across.cross(down).normalized();
  const double width = WidthAlong(interaction.model.objects[object], state.roots[object], along);
  Isometry3d tool = Isometry3d::Identity();
  tool.linear() << along, down.cross(along), down;
  tool.translation() = state.roots[object] * interaction.target->link_from_grasp.translation() -
                       (0.5 * width + kFingerDistance) * along;
  return tool;
}

// Returns the height (m) by which a leaning gripper grasps an object of `height` higher: an edge of
// its palm comes down on the object.
double GraspRise(double pitch, double height) {
  const double clearance = kPalmClearance * std::min(1.0, std::abs(pitch) / kPitches[1]);
  return std::min(kPalmEdge * (1.0 - std::cos(pitch)) + clearance, 0.25 * height);
}

std::span<const double> PitchesOf(const Interaction& interaction,
                                  const Requirements& requirements) {
  if (Pushes(interaction)) return kPushPitches;
  if (interaction.target->pushes) return kShutPitches;
  if (requirements.leans_in) return kRoomPitches;
  return kPitches;
}

// Returns the orientations for both sides of the gripper, whose closing axis is `across` now.
std::vector<GraspOrientation> OrientationsWith(const Interaction& interaction,
                                               const tasks::WorldState& state,
                                               const Vector3d& across, double pitch,
                                               const Requirements& requirements) {
  if (interaction.target->pushes) return {{across, pitch}};
  if (!requirements.leans_in) return {{across, pitch}, {-across, pitch}};
  const Vector3d inward = InwardDirection(*interaction.room, interaction.model, state);
  const Vector3d aside = (-Vector3d::UnitZ()).cross(inward).normalized();
  std::vector<GraspOrientation> orientations;
  for (const GraspOrientation& orientation :
       {GraspOrientation{aside, pitch}, GraspOrientation{-aside, -pitch}}) {
    const Isometry3d tool = GraspPose(interaction, state, orientation.across, orientation.pitch);
    const double lean = tool.linear().col(2).dot(inward);
    if (lean >= kLeanShare * std::sin(pitch)) orientations.push_back(orientation);
  }
  return orientations;
}

// Writes the pre-grasp configuration (J) for `grasp_configuration` (J) into `before`, or the one
// closest to it. Returns false if it is not reached: next to it the gripper would wait forever.
bool FindPreGrasp(const PlanningArm& context, const Interaction& interaction,
                  const tasks::WorldState& state, const robot::JointVector& grasp_configuration,
                  robot::JointVector* before) {
  Isometry3d place = interaction.subtask.start.world_from_robot *
                     robot::ForwardKinematics(context.robot->arm, grasp_configuration);
  Vector3d back = -context.standoff * place.linear().col(2);
  if (interaction.room && IsIn(*interaction.room, interaction.model, state, place.translation())) {
    back = DisplacementOutOfReceptacle(interaction, state, place.translation());
  }
  place.translation() += back;
  CartesianFollower follower(context, interaction, grasp_configuration);
  const bool there = follower.MoveTo(place);
  *before = follower.configuration();
  return there;
}

// Plans the joint path from `from` to the pre-grasp: straight, or through waypoints around
// obstacles. The grasp configuration itself must be collision-free except for the fingers, which
// surround the target. None if there is no path.
std::optional<JointPath> PlanApproachPath(
    const PlanningArm& context, const Interaction& interaction, const tasks::WorldState& state,
    const robot::JointVector& from, const Candidate& candidate, const Requirements& requirements) {
  const bool takes = interaction.target->joint < 0;
  CollisionChecker clearance(context, interaction, state, takes ? interaction.target->object : -1);
  if (takes && !clearance.IsCollisionFree(candidate.configuration)) return std::nullopt;
  const bool palm_free =
      Pushes(interaction) || CollisionChecker(context, interaction, state)
                                 .IsCollisionFree(candidate.configuration, Fingers::kIgnored);
  robot::JointVector before;
  if (!palm_free || !FindPreGrasp(context, interaction, state, candidate.configuration, &before)) {
    return std::nullopt;
  }
  if (requirements.margin > 0.0) clearance.SetClearance(requirements.margin, {from, before});
  if (clearance.IsPathCollisionFree(from, before)) return JointPath();
  return requirements.round ? PlanSimplePath(context, clearance, from, before) : std::nullopt;
}

// Returns candidate closing axes (unit, world): `across`, and those rotated about the vertical that
// grasp a round object differently.
std::vector<Vector3d> ClosingAxes(const Interaction& interaction, const tasks::WorldState& state,
                                  const Vector3d& across) {
  std::vector<Vector3d> lines = {across}, taken;
  if (interaction.target->joint >= 0 || Pushes(interaction)) return lines;
  taken.push_back(GraspPose(interaction, state, across, 0.0).linear().col(1));
  for (const double turn : kReachTurns) {
    const Vector3d line = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * across;
    const Vector3d thin = GraspPose(interaction, state, line, 0.0).linear().col(1);
    const bool new_one = std::all_of(taken.begin(), taken.end(), [&](const Vector3d& other) {
      return std::abs(other.dot(thin)) < kSameLine;
    });
    if (!new_one) continue;
    taken.push_back(thin);
    lines.push_back(line);
  }
  return lines;
}

// Returns the orientations that meet the requirements, as sets of alternatives, the most preferred
// set first: those of each proved grasp in `grasps`, then those from above along `lines`.
std::vector<std::vector<GraspOrientation>> OrientationsToTry(const Interaction& interaction,
                                                             const tasks::WorldState& state,
                                                             const std::vector<Vector3d>& lines,
                                                             const std::vector<int>& grasps,
                                                             const Requirements& requirements) {
  std::vector<std::vector<GraspOrientation>> sets;
  for (const int grasp : grasps) {
    const Isometry3d tool = GraspPose(interaction, state, lines.front(), 0.0, grasp);
    const Vector3d across = tool.linear().col(1);
    if (requirements.leans_in &&
        tool.linear().col(2).dot(InwardDirection(*interaction.room, interaction.model, state)) <
            kLeanShare * std::sin(kRoomPitches[2])) {
      continue;
    }
    sets.push_back({{across, 0.0, grasp}, {-across, 0.0, grasp}});
  }
  const size_t axes = requirements.clear && !requirements.leans_in ? lines.size() : 1;
  for (const double pitch : PitchesOf(interaction, requirements)) {
    for (size_t i = 0; i < axes; ++i) {
      sets.push_back(OrientationsWith(interaction, state, lines[i], pitch, requirements));
    }
  }
  return sets;
}

// Returns a plan with one of `orientations`.
std::optional<ReachPlan> PlanWithOrientations(const PlanningArm& context,
                                              const Interaction& interaction,
                                              const tasks::WorldState& state,
                                              const robot::JointVector& from,
                                              const std::vector<GraspOrientation>& orientations,
                                              const Requirements& requirements, core::Rng& rng) {
  std::vector<Candidate> candidates;
  for (const GraspOrientation& orientation : orientations) {
    AddCandidates(context, interaction, state, orientation, from, rng, &candidates);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.seconds < b.seconds; });
  const bool expensive = interaction.room || (interaction.target->joint >= 0 && requirements.clear);
  if (expensive && candidates.size() > kMostCandidates) {
    candidates.erase(candidates.begin() + kMostCandidates, candidates.end());
  }
  for (const Candidate& candidate : candidates) {
    CartesianFollower follower(context, interaction, candidate.configuration);
    const bool feasible =
        interaction.target->joint >= 0
            ? MovesJoint(context, interaction, state, candidate, requirements, &follower)
            : CanCarry(context, interaction, state, candidate.tool, requirements, &follower);
    if (!feasible) continue;
    const bool goes_on = requirements.looks_ahead && interaction.next;
    ReachPlan plan{.pitch = candidate.pitch,
                   .grasp = candidate.grasp,
                   .grasp_configuration = candidate.configuration,
                   .waypoints = {},
                   .reaches_next = goes_on};
    if (!requirements.clear) return plan;
    const auto path = PlanApproachPath(context, interaction, state, from, candidate, requirements);
    if (!path) continue;
    plan.clear = path->empty();
    plan.waypoints = *path;
    return plan;
  }
  return std::nullopt;
}

}  // namespace

Isometry3d GraspPose(const Interaction& interaction, const tasks::WorldState& state,
                     const Vector3d& across, double pitch, int grasp) {
  const InteractionTarget& target = *interaction.target;
  Isometry3d tool = Isometry3d::Identity();
  if (grasp >= 0) {
    tool = state.roots[static_cast<size_t>(target.object)] *
           target.grasps[static_cast<size_t>(grasp)].object_from_tool;
    if (across.dot(tool.linear().col(1)) < 0.0) tool.linear().leftCols<2>() *= -1.0;
    return tool;
  }
  if (Pushes(interaction)) {
    tool = PushingPose(interaction, state, across);
  } else if (target.joint >= 0) {
    tool = GraspPoseAtJoint(interaction.model, state, target);
    if (!target.pushes && across.dot(tool.linear().col(1)) < 0.0)
      tool.linear().leftCols<2>() *= -1.0;
  } else {
    const Isometry3d& root = state.roots[static_cast<size_t>(target.object)];
    const tasks::ArticulatedObject& taken =
        interaction.model.objects[static_cast<size_t>(target.object)];
    const double yaw = ThinDirection(taken, root, std::atan2(across.y(), across.x()));
    const Vector3d thin(std::cos(yaw), std::sin(yaw), 0.0), down(0.0, 0.0, -1.0);
    tool.linear() << thin.cross(down), thin, down;
    tool.translation() = root * target.link_from_grasp.translation() + target.rim * thin;
    tool.translation().z() += GraspRise(pitch, taken.height());
  }
  tool.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitY()));
  return tool;
}

std::optional<ReachPlan> PlanReach(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, const robot::JointVector& from,
                                   core::Rng& rng, const PathOptions& path_options) {
  const Isometry3d& world_from_base = interaction.subtask.start.world_from_robot;
  const Isometry3d tool_now = world_from_base * robot::ForwardKinematics(context.robot->arm, from);
  const std::vector<Vector3d> lines = ClosingAxes(interaction, state, tool_now.linear().col(1));
  const std::vector<int> grasps = RankGrasps(interaction, state);
  const auto plan = [&](Requirements requirements) -> std::optional<ReachPlan> {
    requirements.margin = path_options.margin;
    for (const auto& orientations :
         OrientationsToTry(interaction, state, lines, grasps, requirements)) {
      if (const auto found = PlanWithOrientations(context, interaction, state, from, orientations,
                                                  requirements, rng)) {
        return found;
      }
    }
    return std::nullopt;
  };
  if (interaction.room) {
    for (const bool clear : {true, false}) {
      const Requirements requirements{.looks_ahead = true, .leans_in = true, .clear = clear};
      if (const auto found = plan(requirements)) return found;
    }
  }
  for (const bool clear : {true, false}) {
    if (interaction.next) {
      if (const auto found = plan({.looks_ahead = true, .clear = clear})) return found;
    }
    if (const auto found = plan({.clear = clear})) return found;
    if (!clear || !path_options.round || interaction.room) continue;
    if (const auto found = plan({.clear = true, .round = true})) return found;
    if (!path_options.part || !interaction.target->pushes) continue;
    const Requirements half{.clear = true, .round = true, .half = true};
    if (const auto found = plan(half)) return found;
  }
  return std::nullopt;
}

Vector3d DisplacementOutOfReceptacle(const Interaction& interaction, const tasks::WorldState& state,
                                     const Vector3d& point) {
  const double depth = std::max(0.0, DepthIn(*interaction.room, interaction.model, state, point));
  const Vector3d out = -InwardDirection(*interaction.room, interaction.model, state);
  const bool over_rim = interaction.target->rim > 0.0 && !interaction.starts_held;
  return (depth + kEntryDistance) * (out + (over_rim ? kRise : 0.0) * Vector3d::UnitZ());
}

robot::JointVector PreGraspConfiguration(const PlanningArm& context, const Interaction& interaction,
                                         const tasks::WorldState& state,
                                         const robot::JointVector& grasp_configuration) {
  robot::JointVector before;
  FindPreGrasp(context, interaction, state, grasp_configuration, &before);
  return before;
}

double OrientationTolerance(const Interaction& interaction) {
  return interaction.target && interaction.target->pushes ? kPushTurned
                                                          : CartesianFollower::kTurned;
}

double PitchOf(const Isometry3d& world_from_tool) {
  const Vector3d axis = world_from_tool.linear().col(2);
  const Vector3d ahead = world_from_tool.linear().col(1).cross(-Vector3d::UnitZ()).normalized();
  return std::atan2(axis.dot(ahead), -axis.z());
}

}  // namespace simwright::manipulation
