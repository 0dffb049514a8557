#include "skills/scripted_expert.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manipulation/goal_displacement.h"
#include "manipulation/joint_target.h"
#include "manipulation/link_pose.h"
#include "manipulation/reach_plan.h"
#include "manipulation/target_geometry.h"
#include "skills/observation.h"

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// The fingers close within the first deviation from the target and open again beyond the second: a
// part that yields between the fingers is not lost.
constexpr double kScriptedExpertNear = 0.03, kLost = 0.045;  // m
// The least of the first deviation. It shrinks with the opening: fingers that are nearly closed
// would close above a thin object.
constexpr double kNarrowNear = 0.012;             // m
constexpr double kAligned = 0.3, kTwisted = 0.8;  // rad
constexpr double kGripGain = 3.0;                 // of the finger command, over the deviation
// The deviation, relative to that at which the fingers open again, up to which the gripper pulls. A
// pull that weakened before that would hold fingers that have slipped off in place forever.
constexpr double kLargestPullDeviation = 1.5;
constexpr double kScriptedExpertFreeLateral = 0.007, kLongestStandoff = 0.04;  // m
constexpr double kStandoffSlope = 4.0;                                         // m per m
constexpr double kClosed = 0.1;         // share of the commanded opening
constexpr double kExpertLead = 0.06;    // m that a part is pulled ahead of itself
constexpr double kHeldAhead = 0.03;     // m, for a grasped lid: faster, the fingers slide off
constexpr double kGentleShare = 0.35;   // share of kAhead, for a door that is open enough
constexpr double kAtStop = 0.01;        // m past the stop of a part that is pushed there
constexpr double kHorizontal = 0.5;     // of a hinge's axis, upwards
constexpr double kSpare = 0.015;        // m on each side of a lid's handle
constexpr double kAheadShut = 0.08;     // m that a door is pushed ahead: it moves far
constexpr double kTurnAhead = 0.35;     // rad
constexpr double kArrived = 0.025;      // m from the destination at which the object is released
constexpr double kAtRest = 0.005;       // m: the gripper is at the frame and makes no more progress
constexpr double kArrivedTurned = 0.1;  // m, tolerance for an object that rotated in the grasp
constexpr double kPushing = 0.02;    // m ahead of the pushing pose the gripper touches the object
constexpr double kPushAhead = 0.02;  // m farther, at most: a faster object slides past its goal
constexpr double kNearGoal = 0.01;   // m: an object this close to its goal is left there

// The inputs of the scripted expert.
struct ExpertInput {
  const SkillVariant& variant;
  const SkillOptions& options;
  const manipulation::TargetFrame& frame;
  const tasks::WorldState& state;
  Vector3d off;            // m, the tool in the target frame
  double angle = 0.0;      // rad, rotation of the tool from the target frame
  double commanded = 0.0;  // share of the opening that the fingers are commanded to
  bool succeeding = false;
  double widest = 0.0;   // m, the maximum opening
  double opening = 0.0;  // m, before the fingers close on a free object
  size_t number = 0;     // of the variant
  const std::vector<std::shared_ptr<const Skill>>& later_skills;
};

ExpertInput InputOf(const Episode& episode) {
  const Skill& skill = episode.skill();
  const SkillVariant& variant = skill.variants[static_cast<size_t>(episode.start().variant)];
  const manipulation::TargetFrame& frame = episode.frame();
  const Isometry3d off = frame.world_from_target().inverse() * episode.state().gripper;
  const Eigen::AngleAxisd straight(-frame.lean(), Vector3d::UnitY());
  const robot::Gripper& gripper = skill.robot->gripper;
  return {variant,
          skill.options,
          frame,
          episode.state(),
          off.translation(),
          Eigen::AngleAxisd(off.linear() * straight).angle(),
          gripper.Opening(episode.command().leader) / gripper.MaxOpening(),
          episode.succeeding(),
          gripper.MaxOpening(),
          OpeningFor(skill, episode.start()),
          static_cast<size_t>(episode.start().variant),
          skill.later_skills};
}

// Returns the deviation of the gripper from its target, relative to that at which the fingers at
// their current opening reverse.
double Deviation(const ExpertInput& input) {
  const double share = input.opening / input.widest;
  const double near = std::max(kNarrowNear, share * kScriptedExpertNear);
  const double open = std::min(1.0, input.commanded / share);
  const double distance = kLost + open * (near - kLost);
  const double angle = kTwisted + open * (kAligned - kTwisted);
  return std::max(input.off.norm() / distance, input.angle / angle);
}

// Returns the finger command: below 0 (close) at the target. It is continuous, since networks learn
// discontinuities late.
double FingerCommand(const ExpertInput& input) {
  return std::clamp(kGripGain * (Deviation(input) - 1.0), -1.0, 1.0);
}

void SetCommand(const Vector3d& part, double unit, float* action) {
  for (int i = 0; i < 3; ++i) {
    action[i] = static_cast<float>(std::clamp(part[i] / unit, -1.0, 1.0));
  }
}

// Makes an open gripper that is laterally off stay farther back than it has to: if it came down a
// finger's breadth aside, a finger would hit the target.
void StandOff(const ExpertInput& input, float* action) {
  const Vector3d& back = input.frame.back();
  const double lateral = (input.off - input.off.dot(back) * back).norm();
  const double stay = kStandoffSlope * std::max(0.0, lateral - kScriptedExpertFreeLateral);
  SetCommand(std::min(stay, kLongestStandoff) * back, input.options.reach, action);
}

// Returns true if a later subtask pushes the part shut: if it is opened only as far as needed, the
// arm has a path behind it. Otherwise the next subtask has more room beside it.
bool IsShutLater(const ExpertInput& input) {
  const manipulation::InteractionTarget& target = *input.variant.target;
  return std::any_of(input.later_skills.begin(), input.later_skills.end(), [&](const auto& skill) {
    const std::optional<manipulation::InteractionTarget>& shut =
        skill->variants[input.number].target;
    return shut && shut->pushes && shut->object == target.object && shut->joint == target.joint;
  });
}

// Returns true for lids, for example: they are below their handle, and their weight pulls them out
// of the grasp.
bool HasHorizontalHinge(const ExpertInput& input) {
  const manipulation::InteractionTarget& target = *input.variant.target;
  const tasks::ObjectJoint& joint = input.variant.model.objects[static_cast<size_t>(target.object)]
                                        .joints[static_cast<size_t>(target.joint)];
  if (joint.type == reward::RewardJointType::kPrismatic) return false;
  const Isometry3d link =
      manipulation::WorldFromLink(input.variant.model, input.state, target.object, joint.link);
  return std::abs((link.linear() * joint.axis).z()) < kHorizontal;
}

// Returns the opening (m) of the fingers for a part: if the gripper leans, one fingertip is lower
// than the other, and wide open it would touch the lid and never close.
double OpeningForPart(const ExpertInput& input) {
  if (!HasHorizontalHinge(input)) return input.widest;
  const manipulation::TargetGeometry part = manipulation::GeometryOf(
      input.variant.model, input.state, *input.variant.target, input.frame.world_from_target());
  return std::min(input.widest, part.size.y() + 2.0 * kSpare);
}

// Returns the finger command for an `opening` (m): `grip`, which opens, unless that is too wide.
double OpenTo(double opening, double grip, const ExpertInput& input) {
  const double share = opening / input.widest;
  if (share >= 1.0) return grip;
  return std::min(grip, std::clamp(kGripGain * (share - input.commanded), -1.0, 1.0));
}

// Returns the way (m) that is left to a sliding part that is pushed back to its rest position,
// where it stops; infinite for all others. Fingers that push on there slide off the handle.
double WayToStop(const ExpertInput& input) {
  const manipulation::InteractionTarget& target = *input.variant.target;
  const auto object = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
  const tasks::ObjectJoint& joint = input.variant.model.objects[object].joints[j];
  const bool closes =
      joint.type == reward::RewardJointType::kPrismatic &&
      manipulation::JointTarget(joint, input.variant.start.joints[object][j]) == joint.rest();
  return closes ? std::abs(input.state.joints[object][j] - joint.rest())
                : std::numeric_limits<double>::infinity();
}

void ManipulatePart(const ExpertInput& input, float* action) {
  double grip = FingerCommand(input);
  if (grip > 0.0) {
    StandOff(input, action);
    grip = OpenTo(OpeningForPart(input), grip, input);
  }
  action[6] = static_cast<float>(grip);
  const double pull = std::clamp(kGripGain * (kLargestPullDeviation - Deviation(input)), 0.0, 1.0) *
                      std::max(0.0, 1.0 - input.commanded / kClosed);
  if (pull == 0.0) return;
  const Vector3d direction = input.frame.motion_direction();
  if (!direction.isZero()) {
    const double gently = input.succeeding && IsShutLater(input) ? kGentleShare : 1.0;
    const double ahead =
        HasHorizontalHinge(input) && input.state.grasped ? kHeldAhead : kExpertLead;
    const double lead = std::min(gently * pull * ahead, WayToStop(input) + kAtStop);
    SetCommand(lead * direction, input.options.reach, action);
    return;
  }
  const manipulation::InteractionTarget& target = *input.variant.target;
  const auto object = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
  const tasks::ObjectJoint& joint = input.variant.model.objects[object].joints[j];
  const double described = input.variant.start.joints[object][j];
  const double sense = manipulation::JointTarget(joint, described) > described ? 1.0 : -1.0;
  const Isometry3d link =
      manipulation::WorldFromLink(input.variant.model, input.state, target.object, joint.link);
  const Vector3d axis =
      input.frame.world_from_target().linear().transpose() * link.linear() * joint.axis;
  SetCommand(pull * sense * kTurnAhead * axis, input.options.turn, action + 3);
}

// Pushes the part with closed fingers behind it; how far they yield, or the part is ahead of them,
// does not matter.
void PushShut(const ExpertInput& input, float* action) {
  action[6] = -1.0f;
  const Vector3d lateral(std::max(0.0, input.off.x() - kScriptedExpertNear), input.off.y(),
                         input.off.z());
  const double off = std::max(lateral.norm() / kScriptedExpertNear,
                              input.angle / manipulation::OrientationTolerance(input.variant));
  const double push = std::clamp(kGripGain * (kLargestPullDeviation - off), 0.0, 1.0);
  SetCommand(push * kAheadShut * input.frame.motion_direction(), input.options.reach, action);
}

void Push(const ExpertInput& input, float* action) {
  action[6] = -1.0f;
  const bool behind = std::abs(input.off.y()) < kLost && std::abs(input.off.z()) < kLost &&
                      input.off.x() < 2.0 * kPushing;
  if (!behind) return;
  // Along the direction of pushing: an object that slid past its goal is not pushed on.
  const double missing = manipulation::DisplacementToDestination(input.variant, input.state)
                             .dot(input.frame.world_from_target().linear().col(0));
  if (missing < kNearGoal) return;
  const double ahead = std::min(missing - kNearGoal, kPushAhead);
  SetCommand(Vector3d(ahead + kPushing, 0.0, 0.0), input.options.reach, action);
}

void Carry(const ExpertInput& input, float* action) {
  const bool putting = input.variant.starts_held;
  if (input.frame.at_destination()) {
    const double missing =
        manipulation::DisplacementToDestination(input.variant, input.state).norm();
    // In a receptacle, an object that rotated in the grasp is not where the gripper would have it.
    const bool at_rest = input.variant.room && input.off.norm() < kAtRest;
    const double arrived = at_rest ? kArrivedTurned : kArrived;
    const double early = putting ? kGripGain * (1.0 - missing / arrived) : -1.0;
    action[6] = static_cast<float>(std::clamp(early, -1.0, 1.0));
    return;
  }
  double grip = FingerCommand(input);
  if (grip > 0.0) {
    StandOff(input, action);
    grip = OpenTo(input.opening, grip, input);
  }
  action[6] = static_cast<float>(grip);
  const bool held = input.state.grasped && input.state.touched == input.variant.target->object;
  if (!held || input.variant.destination) return;
  const Vector3d up = input.frame.world_from_target().linear().transpose() * Vector3d::UnitZ();
  SetCommand(input.options.reach * up, input.options.reach, action);
}

}  // namespace

bool HasScriptedExpert(const Skill& skill) {
  return skill.options.action == ActionSpace::kTargetFrame ||
         skill.options.action == ActionSpace::kGuided;
}

void ExpertAction(const Episode& episode, float* action) {
  std::fill(action, action + 7, 0.0f);
  const ExpertInput input = InputOf(episode);
  if (!input.variant.target) return;
  if (input.frame.retreating()) {
    action[6] = 1.0f;
  } else if (input.variant.target->pushes) {
    PushShut(input, action);
  } else if (input.variant.target->joint >= 0) {
    ManipulatePart(input, action);
  } else if (manipulation::Pushes(input.variant)) {
    Push(input, action);
  } else {
    Carry(input, action);
  }
}

}  // namespace simwright::skills
