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

// The hand closes where it is so near to its work, and opens again where it has lost it by more:
// what gives way between its fingers is not lost.
constexpr double kThere = 0.03, kLost = 0.045;    // m
constexpr double kAligned = 0.3, kTwisted = 0.8;  // rad
constexpr double kGripGain = 3.0;                 // of the action, over the share that is missing
// Of where the fingers open again: so far the hand pulls on. A pull that got weaker before that
// would hold closed fingers that have slipped off where they are, for ever.
constexpr double kPullsTo = 1.5;
constexpr double kBesideFree = 0.007, kFarthestBack = 0.04;  // m
constexpr double kBackPerBeside = 4.0;                       // m a m
constexpr double kClosed = 0.1;                              // of the opening that is asked for
constexpr double kAhead = 0.06;         // m that a part is pulled by ahead of it
constexpr double kHeldAhead = 0.03;     // m, of a lid between both fingers: faster, they slide off
constexpr double kGently = 0.35;        // of kAhead, of a door that is open enough
constexpr double kLevel = 0.5;          // of a hinge's axis, upwards
constexpr double kSpare = 0.015;        // m on each side of a lid's handle
constexpr double kAheadShut = 0.08;     // m that a door is pushed by: it is wide, and goes far
constexpr double kTurnAhead = 0.35;     // rad
constexpr double kArrived = 0.025;      // m from the destination: lets go
constexpr double kAtRest = 0.005;       // m: the hand is where it shall be, and gets no nearer
constexpr double kArrivedTurned = 0.1;  // m that what has turned in it may be off then
constexpr double kPushing = 0.02;    // m ahead of its place behind it, the hand touches the thing
constexpr double kPushAhead = 0.02;  // m farther, at most: what goes faster slides past its goal
constexpr double kNearGoal = 0.01;   // m: what is so near to its goal is left there

// What the script looks at.
struct Glance {
  const SkillVariant& variant;
  const SkillOptions& options;
  const FocusFrame& frame;
  const tasks::SceneState& state;
  Vector3d off;        // m, the tool from where it works, in the focus' frame
  double angle = 0.0;  // rad that it is turned
  double asked = 0.0;  // share of the opening that the fingers are sent to
  bool succeeding = false;
  double widest = 0.0;  // m that the hand opens
  size_t number = 0;    // of the variant
  const std::vector<std::shared_ptr<const Skill>>& later;
};

Glance GlanceAt(const Episode& episode) {
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

// How far the hand is off its work: 1 where fingers that are so far open or closed turn round.
double OffAt(const Glance& glance) {
  const double distance = kLost + glance.asked * (kThere - kLost);
  const double angle = kTwisted + glance.asked * (kAligned - kTwisted);
  return std::max(glance.off.norm() / distance, glance.angle / angle);
}

// What the fingers shall do: close, below 0, where the hand is at its work. Without jumps, which a
// network learns late.
double GripAt(const Glance& glance) {
  return std::clamp(kGripGain * (OffAt(glance) - 1.0), -1.0, 1.0);
}

void Ask(const Vector3d& part, double unit, float* action) {
  for (int i = 0; i < 3; ++i) {
    action[i] = static_cast<float>(std::clamp(part[i] / unit, -1.0, 1.0));
  }
}

// An open hand that is beside its work stays farther back than it has to: were it let down a
// fingerbreadth aside, a finger would come down on what it shall take.
void ComeFromBehind(const Glance& glance, float* action) {
  const Vector3d& back = glance.frame.back();
  const double beside = (glance.off - glance.off.dot(back) * back).norm();
  const double stay = kBackPerBeside * std::max(0.0, beside - kBesideFree);
  Ask(std::min(stay, kFarthestBack) * back, glance.options.reach, action);
}

// Whether a subtask that comes later pushes the part shut: opened little wider than it has to be,
// it leaves the arm a way behind it. Where none does, what comes next has more room beside it.
bool IsShutLater(const Glance& glance) {
  const Focus& focus = *glance.variant.focus;
  return std::any_of(glance.later.begin(), glance.later.end(), [&](const auto& skill) {
    const std::optional<Focus>& shut = skill->variants[glance.number].focus;
    return shut && shut->pushes && shut->thing == focus.thing && shut->joint == focus.joint;
  });
}

// Lids have: they lie under their handle, and their weight pulls them out of the hand.
bool HasLevelHinge(const Glance& glance) {
  const Focus& focus = *glance.variant.focus;
  const tasks::ThingJoint& joint = glance.variant.model.things[static_cast<size_t>(focus.thing)]
                                       .joints[static_cast<size_t>(focus.joint)];
  if (joint.type == tasks::RewardJointType::kPrismatic) return false;
  const Isometry3d link =
      WorldFromLink(glance.variant.model, glance.state, focus.thing, joint.link);
  return std::abs((link.linear() * joint.axis).z()) < kLevel;
}

// m that the fingers open for a part: of a hand that leans one fingertip is lower than the other,
// and wide open it would stand on the lid and never close.
double OpeningFor(const Glance& glance) {
  if (!HasLevelHinge(glance)) return glance.widest;
  const FocusGeometry part = GeometryOf(glance.variant.model, glance.state, *glance.variant.focus,
                                        glance.frame.world_from_focus());
  return std::min(glance.widest, part.size.y() + 2.0 * kSpare);
}

void WorkPart(const Glance& glance, float* action) {
  double grip = GripAt(glance);
  if (grip > 0.0) {
    ComeFromBehind(glance, action);
    const double opening = OpeningFor(glance) / glance.widest;
    if (opening < 1.0) grip = std::clamp(kGripGain * (opening - glance.asked), -1.0, 1.0);
  }
  action[6] = static_cast<float>(grip);
  const double pull = std::clamp(kGripGain * (kPullsTo - OffAt(glance)), 0.0, 1.0) *
                      std::max(0.0, 1.0 - glance.asked / kClosed);
  if (pull == 0.0) return;
  const Vector3d way = glance.frame.free_way();
  if (!way.isZero()) {
    const double gently = glance.succeeding && IsShutLater(glance) ? kGently : 1.0;
    const double ahead = HasLevelHinge(glance) && glance.state.grasped ? kHeldAhead : kAhead;
    Ask(gently * pull * ahead * way, glance.options.reach, action);
    return;
  }
  const Focus& focus = *glance.variant.focus;
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  const tasks::ThingJoint& joint = glance.variant.model.things[thing].joints[j];
  const double described = glance.variant.start.joints[thing][j];
  const double sense = WorkEnd(joint, described) > described ? 1.0 : -1.0;
  const Isometry3d link =
      WorldFromLink(glance.variant.model, glance.state, focus.thing, joint.link);
  const Vector3d axis =
      glance.frame.world_from_focus().linear().transpose() * link.linear() * joint.axis;
  Ask(pull * sense * kTurnAhead * axis, glance.options.turn, action + 3);
}

// Closed fingers that are behind the part push it on; how far they give way before it does, or it
// is ahead of them, is no matter.
void PushShut(const Glance& glance, float* action) {
  action[6] = -1.0f;
  const Vector3d beside(std::max(0.0, glance.off.x() - kThere), glance.off.y(), glance.off.z());
  const double off = std::max(beside.norm() / kThere, glance.angle / PushTurned(glance.variant));
  const double push = std::clamp(kGripGain * (kPullsTo - off), 0.0, 1.0);
  Ask(push * kAheadShut * glance.frame.free_way(), glance.options.reach, action);
}

void Push(const Glance& glance, float* action) {
  action[6] = -1.0f;
  const bool behind = std::abs(glance.off.y()) < kLost && std::abs(glance.off.z()) < kLost &&
                      glance.off.x() < 2.0 * kPushing;
  if (!behind) return;
  // Along the way that it is pushed: what has slid past its goal is not pushed on.
  const double missing = WayToDestination(glance.variant, glance.state)
                             .dot(glance.frame.world_from_focus().linear().col(0));
  if (missing < kNearGoal) return;
  const double ahead = std::min(missing - kNearGoal, kPushAhead);
  Ask(Vector3d(ahead + kPushing, 0.0, 0.0), glance.options.reach, action);
}

void Carry(const Glance& glance, float* action) {
  const bool putting = glance.variant.starts_held;
  if (glance.frame.at_destination()) {
    const double missing = WayToDestination(glance.variant, glance.state).norm();
    // What has turned in the hand, in a room, is not where the hand would have it.
    const bool at_rest = glance.variant.room && glance.off.norm() < kAtRest;
    const double arrived = at_rest ? kArrivedTurned : kArrived;
    const double early = putting ? kGripGain * (1.0 - missing / arrived) : -1.0;
    action[6] = static_cast<float>(std::clamp(early, -1.0, 1.0));
    return;
  }
  const double grip = GripAt(glance);
  action[6] = static_cast<float>(grip);
  if (grip > 0.0) ComeFromBehind(glance, action);
  const bool held = glance.state.grasped && glance.state.touched == glance.variant.focus->thing;
  if (!held || glance.variant.destination) return;
  const Vector3d up = glance.frame.world_from_focus().linear().transpose() * Vector3d::UnitZ();
  Ask(glance.options.reach * up, glance.options.reach, action);
}

}  // namespace

bool HasScript(const Skill& skill) {
  return skill.options.action == ActionSpace::kFocus ||
         skill.options.action == ActionSpace::kGuided;
}

void ScriptedAction(const Episode& episode, float* action) {
  std::fill(action, action + 7, 0.0f);
  const Glance glance = GlanceAt(episode);
  if (!glance.variant.focus) return;
  if (glance.frame.withdrawing()) {
    action[6] = 1.0f;
  } else if (glance.variant.focus->pushes) {
    PushShut(glance, action);
  } else if (glance.variant.focus->joint >= 0) {
    WorkPart(glance, action);
  } else if (Pushes(glance.variant)) {
    Push(glance, action);
  } else {
    Carry(glance, action);
  }
}

}  // namespace simwright::rl
