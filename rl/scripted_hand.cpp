#include "rl/scripted_hand.h"

#include <algorithm>
#include <cmath>

#include "rl/focus_geometry.h"
#include "rl/joint_work.h"
#include "rl/link_pose.h"
#include "rl/observation.h"
#include "rl/reach_plan.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// The fingers close within the first deviation from the target and open again beyond the second: a
// part that yields between the fingers is not lost.
constexpr double kNear = 0.03, kLost = 0.045;     // m
constexpr double kAligned = 0.3, kTwisted = 0.8;  // rad
constexpr double kGripGain = 3.0;                 // of the finger command, over the deviation
// The deviation, relative to that at which the fingers open again, up to which the gripper pulls. A
// pull that weakened before that would hold fingers that have slipped off in place forever.
constexpr double kLargestPullDeviation = 1.5;
constexpr double kFreeLateral = 0.007, kLongestStandoff = 0.04;  // m
constexpr double kStandoffSlope = 4.0;                           // m per m
constexpr double kClosed = 0.1;                                  // share of the commanded opening
constexpr double kAhead = 0.06;         // m that a part is pulled ahead of itself
constexpr double kHeldAhead = 0.03;     // m, for a grasped lid: faster, the fingers slide off
constexpr double kGentleShare = 0.35;   // share of kAhead, for a door that is open enough
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
  const FocusFrame& frame;
  const tasks::SceneState& state;
  Vector3d off;            // m, the tool in the target frame
  double angle = 0.0;      // rad, rotation of the tool from the target frame
  double commanded = 0.0;  // share of the opening that the fingers are commanded to
  bool succeeding = false;
  double widest = 0.0;  // m, the maximum opening
  size_t number = 0;    // of the variant
  const std::vector<std::shared_ptr<const Skill>>& later;
};

ExpertInput InputOf(const Episode& episode) {
  const Skill& skill = episode.skill();
  const SkillVariant& variant = skill.variants[static_cast<size_t>(episode.start().variant)];
  const FocusFrame& frame = episode.frame();
  const Isometry3d off = frame.world_from_focus().inverse() * episode.state().gripper;
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
          static_cast<size_t>(episode.start().variant),
          skill.later};
}

// Returns the deviation of the gripper from its target, relative to that at which the fingers at
// their current opening reverse.
double Deviation(const ExpertInput& input) {
  const double distance = kLost + input.commanded * (kNear - kLost);
  const double angle = kTwisted + input.commanded * (kAligned - kTwisted);
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
  const double stay = kStandoffSlope * std::max(0.0, lateral - kFreeLateral);
  SetCommand(std::min(stay, kLongestStandoff) * back, input.options.reach, action);
}

// Returns true if a later subtask pushes the part shut: if it is opened only as far as needed, the
// arm has a path behind it. Otherwise the next subtask has more room beside it.
bool IsShutLater(const ExpertInput& input) {
  const Focus& focus = *input.variant.focus;
  return std::any_of(input.later.begin(), input.later.end(), [&](const auto& skill) {
    const std::optional<Focus>& shut = skill->variants[input.number].focus;
    return shut && shut->pushes && shut->thing == focus.thing && shut->joint == focus.joint;
  });
}

// Returns true for lids, for example: they are below their handle, and their weight pulls them out
// of the grasp.
bool HasHorizontalHinge(const ExpertInput& input) {
  const Focus& focus = *input.variant.focus;
  const tasks::ThingJoint& joint = input.variant.model.things[static_cast<size_t>(focus.thing)]
                                       .joints[static_cast<size_t>(focus.joint)];
  if (joint.type == tasks::RewardJointType::kPrismatic) return false;
  const Isometry3d link = WorldFromLink(input.variant.model, input.state, focus.thing, joint.link);
  return std::abs((link.linear() * joint.axis).z()) < kHorizontal;
}

// Returns the opening (m) of the fingers for a part: if the gripper leans, one fingertip is lower
// than the other, and wide open it would touch the lid and never close.
double OpeningFor(const ExpertInput& input) {
  if (!HasHorizontalHinge(input)) return input.widest;
  const FocusGeometry part = GeometryOf(input.variant.model, input.state, *input.variant.focus,
                                        input.frame.world_from_focus());
  return std::min(input.widest, part.size.y() + 2.0 * kSpare);
}

void ManipulatePart(const ExpertInput& input, float* action) {
  double grip = FingerCommand(input);
  if (grip > 0.0) {
    StandOff(input, action);
    const double opening = OpeningFor(input) / input.widest;
    if (opening < 1.0) grip = std::clamp(kGripGain * (opening - input.commanded), -1.0, 1.0);
  }
  action[6] = static_cast<float>(grip);
  const double pull = std::clamp(kGripGain * (kLargestPullDeviation - Deviation(input)), 0.0, 1.0) *
                      std::max(0.0, 1.0 - input.commanded / kClosed);
  if (pull == 0.0) return;
  const Vector3d way = input.frame.free_way();
  if (!way.isZero()) {
    const double gently = input.succeeding && IsShutLater(input) ? kGentleShare : 1.0;
    const double ahead = HasHorizontalHinge(input) && input.state.grasped ? kHeldAhead : kAhead;
    SetCommand(gently * pull * ahead * way, input.options.reach, action);
    return;
  }
  const Focus& focus = *input.variant.focus;
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  const tasks::ThingJoint& joint = input.variant.model.things[thing].joints[j];
  const double described = input.variant.start.joints[thing][j];
  const double sense = WorkEnd(joint, described) > described ? 1.0 : -1.0;
  const Isometry3d link = WorldFromLink(input.variant.model, input.state, focus.thing, joint.link);
  const Vector3d axis =
      input.frame.world_from_focus().linear().transpose() * link.linear() * joint.axis;
  SetCommand(pull * sense * kTurnAhead * axis, input.options.turn, action + 3);
}

// Pushes the part with closed fingers behind it; how far they yield, or the part is ahead of them,
// does not matter.
void PushShut(const ExpertInput& input, float* action) {
  action[6] = -1.0f;
  const Vector3d lateral(std::max(0.0, input.off.x() - kNear), input.off.y(), input.off.z());
  const double off = std::max(lateral.norm() / kNear, input.angle / PushTurned(input.variant));
  const double push = std::clamp(kGripGain * (kLargestPullDeviation - off), 0.0, 1.0);
  SetCommand(push * kAheadShut * input.frame.free_way(), input.options.reach, action);
}

void Push(const ExpertInput& input, float* action) {
  action[6] = -1.0f;
  const bool behind = std::abs(input.off.y()) < kLost && std::abs(input.off.z()) < kLost &&
                      input.off.x() < 2.0 * kPushing;
  if (!behind) return;
  // Along the direction of pushing: an object that slid past its goal is not pushed on.
  const double missing = WayToDestination(input.variant, input.state)
                             .dot(input.frame.world_from_focus().linear().col(0));
  if (missing < kNearGoal) return;
  const double ahead = std::min(missing - kNearGoal, kPushAhead);
  SetCommand(Vector3d(ahead + kPushing, 0.0, 0.0), input.options.reach, action);
}

void Carry(const ExpertInput& input, float* action) {
  const bool putting = input.variant.starts_held;
  if (input.frame.at_destination()) {
    const double missing = WayToDestination(input.variant, input.state).norm();
    // In a receptacle, an object that rotated in the grasp is not where the gripper would have it.
    const bool at_rest = input.variant.room && input.off.norm() < kAtRest;
    const double arrived = at_rest ? kArrivedTurned : kArrived;
    const double early = putting ? kGripGain * (1.0 - missing / arrived) : -1.0;
    action[6] = static_cast<float>(std::clamp(early, -1.0, 1.0));
    return;
  }
  const double grip = FingerCommand(input);
  action[6] = static_cast<float>(grip);
  if (grip > 0.0) StandOff(input, action);
  const bool held = input.state.grasped && input.state.touched == input.variant.focus->thing;
  if (!held || input.variant.destination) return;
  const Vector3d up = input.frame.world_from_focus().linear().transpose() * Vector3d::UnitZ();
  SetCommand(input.options.reach * up, input.options.reach, action);
}

}  // namespace

bool HasScript(const Skill& skill) {
  return skill.options.action == ActionSpace::kFocus ||
         skill.options.action == ActionSpace::kGuided;
}

void ScriptedAction(const Episode& episode, float* action) {
  std::fill(action, action + 7, 0.0f);
  const ExpertInput input = InputOf(episode);
  if (!input.variant.focus) return;
  if (input.frame.withdrawing()) {
    action[6] = 1.0f;
  } else if (input.variant.focus->pushes) {
    PushShut(input, action);
  } else if (input.variant.focus->joint >= 0) {
    ManipulatePart(input, action);
  } else if (Pushes(input.variant)) {
    Push(input, action);
  } else {
    Carry(input, action);
  }
}

}  // namespace simwright::rl
