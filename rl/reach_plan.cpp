#include "rl/reach_plan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "rl/arm_clearance.h"
#include "rl/observation.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPosition = 0.01, kAngle = 0.15;  // m, rad: what is off at most
constexpr double kStride = 0.03;                   // m of the tool between two looks
constexpr double kTurn = 0.12;                     // rad
constexpr double kJointStep = 0.1;                 // rad or m of any joint in one look
constexpr double kFinger = 0.03;  // m behind what is pushed: fingers lean, walls lean out
// m: nearer to its goal a thing is pushed on as before. The hand would else have to go round it
// whenever it is past its goal.
constexpr double kThere = 0.04;
constexpr double kPitches[] = {0.0, 0.35, -0.35, 0.7, -0.7};
// Of a hand that pushes: leaning back it has its palm behind the thing, and not on top of it, so
// that the fingers push below the middle. Upright, the palm comes down on whatever is taller than
// the fingers are long.
constexpr double kPushPitches[] = {0.6, 0.8, 0.4};
// Of a hand that goes into a room through its side: palm and wrist stay out of it, or below its
// ceiling. A microwave is 20 cm high inside; upright, hand and flange alone are 25.
constexpr double kRoomPitches[] = {0.8, 1.0, 0.6, 1.2};
constexpr double kLeaning = 0.9;  // of the lean, into the room: things with corners turn the hand
constexpr int kRoomPostures = 6;  // that are looked at: whether an arm is clear takes a millisecond
constexpr double kPalmEdge = 0.04;  // m: what the edge comes down by, over 1 - cos(lean)
constexpr double kUpright = 0.8;    // of a thing's z axis
constexpr int kPostures = 8;        // that are tried with each, for either side of the hand

// Follows poses with the tracker that training uses.
class Follower {
 public:
  Follower(const Skill& skill, const SkillVariant& variant, const robot::Posture& from)
      : skill_(skill),
        base_from_world_(variant.subtask.start.world_from_robot.inverse()),
        step_(robot::Posture::Constant(from.size(), kJointStep)),
        posture_(from) {}

  // Whether the tool gets to `world_from_tool`.
  bool Goes(const Isometry3d& world_from_tool) {
    const Isometry3d target = base_from_world_ * world_from_tool;
    const Isometry3d now = robot::ForwardKinematics(skill_.robot->arm, posture_);
    const Eigen::Quaterniond a(now.linear()), b(target.linear());
    const double way = (target.translation() - now.translation()).norm();
    const int strides = 1 + static_cast<int>(std::max(way / kStride, a.angularDistance(b) / kTurn));
    robot::PoseError error;
    for (int i = 1; i <= strides + 4; ++i) {
      const double share = std::min(1.0, static_cast<double>(i) / strides);
      Isometry3d next = Isometry3d::Identity();
      next.translation() = now.translation() + share * (target.translation() - now.translation());
      next.linear() = a.slerp(share, b).toRotationMatrix();
      error = skill_.kinematics->Track(next, step_, &posture_);
    }
    return error.position < kPosition && error.angle < kAngle;
  }
  const robot::Posture& posture() const { return posture_; }

 private:
  const Skill& skill_;
  Isometry3d base_from_world_;
  robot::Posture step_;
  robot::Posture posture_;
};

// From where the joint stands to where it shall go.
std::vector<double> JointWay(const tasks::ThingJoint& joint, double position) {
  const double end = WorkEnd(joint, position);
  std::vector<double> way;
  for (int i = 1; i <= 6; ++i) way.push_back(position + (end - position) * i / 6.0);
  return way;
}

// A way for the hand to stand at its work.
struct Stance {
  Vector3d across;  // unit, world: the tool's y axis
  double pitch = 0.0;
};

// What has to be true of a plan.
struct Demands {
  bool looks_ahead = false;  // the thing can go on to variant.next
  bool leans_in = false;     // the hand leans into variant.room
};

// Whether the tool goes to `there` in variant.room through its opening, the arm being in nothing.
bool GoesIn(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
            const Isometry3d& there, Follower* follower) {
  const Vector3d inward = InwardOf(*variant.room, variant.model, state);
  const double depth = DepthIn(*variant.room, variant.model, state, there.translation());
  Isometry3d before = there;
  before.translation() -= (std::max(0.0, depth) + kBeforeOpening) * inward;
  for (const Isometry3d& place : {before, there}) {
    if (!follower->Goes(place)) return false;
    const robot::Posture& arm = follower->posture();
    if (!IsArmClear(skill, variant, state, arm, variant.focus->thing)) return false;
  }
  return true;
}

// Whether a thing that is taken with the tool at `tool` can be brought where it shall go.
bool CarriesThing(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                  const Isometry3d& tool, const Demands& demands, Follower* follower) {
  const auto goes = [&](const Destination& destination) {
    Isometry3d there = tool;
    there.translation() += WayTo(destination, variant, state);
    if (destination.room) return GoesIn(skill, variant, state, there, follower);
    return follower->Goes(there);
  };
  const bool inside = variant.room && IsIn(*variant.room, variant.model, state, tool.translation());
  if (inside && !GoesIn(skill, variant, state, tool, follower)) return false;
  if (variant.destination && !goes(*variant.destination)) return false;
  return !demands.looks_ahead || !variant.next || goes(*variant.next);
}

bool MovesJoint(const SkillVariant& variant, tasks::SceneState state, const Isometry3d& tool,
                double pitch, Follower* follower) {
  const Focus& focus = *variant.focus;
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  Vector3d across = tool.linear().col(1);
  for (const double position :
       JointWay(variant.model.things[thing].joints[j], state.joints[thing][j])) {
    state.joints[thing][j] = position;
    const Isometry3d next = ToolAtFocus(variant, state, across, pitch);
    across = next.linear().col(1);
    if (!follower->Goes(next)) return false;
  }
  return true;
}

// Somewhere about `from`, a share of each joint's range to either side.
robot::Posture PostureAbout(const robot::Posture& from, double share, const robot::Arm& arm,
                            core::Rng& rng) {
  robot::Posture posture = from;
  for (Eigen::Index j = 0; j < posture.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    const double range = share * (joint.upper - joint.lower);
    posture[j] = std::clamp(from[j] + core::Uniform(rng, -range, range), joint.lower, joint.upper);
  }
  return posture;
}

// A posture in which the tool is at work.
struct Candidate {
  Isometry3d tool;  // world_from_tool
  double pitch = 0.0;
  robot::Posture posture;
  double seconds = 0.0;  // to get there, every joint at its highest speed
};

double TravelTime(const robot::RobotModel& robot, const robot::Posture& way) {
  double seconds = 0.0;
  for (Eigen::Index j = 0; j < way.size(); ++j) {
    const auto joint = static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)]);
    seconds = std::max(seconds, std::abs(way[j]) / robot.limits[joint].velocity);
  }
  return seconds;
}

void AddCandidates(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                   const Stance& stance, const robot::Posture& from, core::Rng& rng,
                   std::vector<Candidate>* candidates) {
  const Isometry3d tool = ToolAtFocus(variant, state, stance.across, stance.pitch);
  const Isometry3d target = variant.subtask.start.world_from_robot.inverse() * tool;
  robot::Posture start = from;
  for (int i = 0; i < kPostures; ++i) {
    const robot::PoseSolution found = skill.kinematics->Solve(target, start, rng);
    if (!found.reached) {
      if (i == 0) return;  // out of reach, as a rule
      continue;
    }
    const double seconds = TravelTime(*skill.robot, found.q - from);
    candidates->push_back({tool, stance.pitch, found.q, seconds});
    const double share = static_cast<double>(i + 1) / kPostures;
    start = PostureAbout(from, share, skill.robot->arm, rng);
  }
}

// x along the way that the thing shall go, z down, the origin behind the thing.
Isometry3d ToolBehind(const SkillVariant& variant, const tasks::SceneState& state,
                      const Vector3d& across) {
  const auto thing = static_cast<size_t>(variant.focus->thing);
  const Vector3d down = -Vector3d::UnitZ();
  Vector3d way = WayToDestination(variant, state);
  way.z() = 0.0;
  const Vector3d along = way.norm() > kThere ? way.normalized() : across.cross(down).normalized();
  const double width = WidthAlong(variant.model.things[thing], state.roots[thing], along);
  Isometry3d tool = Isometry3d::Identity();
  tool.linear() << along, down.cross(along), down;
  tool.translation() = state.roots[thing] * variant.focus->link_from_tool.translation() -
                       (0.5 * width + kFinger) * along;
  return tool;
}

// m that a hand which leans takes a thing of `height` less deep: an edge of its palm comes down on
// it.
double Shallower(double pitch, double height) {
  return std::min(kPalmEdge * (1.0 - std::cos(pitch)), 0.25 * height);
}

std::span<const double> PitchesOf(const SkillVariant& variant, const Demands& demands) {
  if (Pushes(variant)) return kPushPitches;
  if (demands.leans_in) return kRoomPitches;
  return kPitches;
}

// For both sides of the hand, whose y axis is `across` now.
std::vector<Stance> StancesWith(const SkillVariant& variant, const tasks::SceneState& state,
                                const Vector3d& across, double pitch, const Demands& demands) {
  if (!demands.leans_in) return {{across, pitch}, {-across, pitch}};
  const Vector3d inward = InwardOf(*variant.room, variant.model, state);
  const Vector3d aside = (-Vector3d::UnitZ()).cross(inward).normalized();
  std::vector<Stance> stances;
  for (const Stance& stance : {Stance{aside, pitch}, Stance{-aside, -pitch}}) {
    const Isometry3d tool = ToolAtFocus(variant, state, stance.across, stance.pitch);
    const double lean = tool.linear().col(2).dot(inward);
    if (lean >= kLeaning * std::sin(pitch)) stances.push_back(stance);
  }
  return stances;
}

// A plan with one of `stances`.
std::optional<ReachPlan> PlanWith(const Skill& skill, const SkillVariant& variant,
                                  const tasks::SceneState& state, const robot::Posture& from,
                                  const std::vector<Stance>& stances, const Demands& demands,
                                  core::Rng& rng) {
  std::vector<Candidate> candidates;
  for (const Stance& stance : stances) {
    AddCandidates(skill, variant, state, stance, from, rng, &candidates);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.seconds < b.seconds; });
  if (variant.room && candidates.size() > kRoomPostures) {
    candidates.erase(candidates.begin() + kRoomPostures, candidates.end());
  }
  for (const Candidate& candidate : candidates) {
    Follower follower(skill, variant, candidate.posture);
    const bool works =
        variant.focus->joint >= 0
            ? MovesJoint(variant, state, candidate.tool, candidate.pitch, &follower)
            : CarriesThing(skill, variant, state, candidate.tool, demands, &follower);
    if (works) return ReachPlan{candidate.pitch, candidate.posture};
  }
  return std::nullopt;
}

}  // namespace

double WorkEnd(const tasks::ThingJoint& joint, double position) {
  const double rest = joint.rest(), most = rest + 0.8 * (joint.far() - rest);
  return std::abs(position - rest) > std::abs(position - most) ? rest : most;
}

bool Pushes(const SkillVariant& variant) {
  return variant.focus && variant.focus->joint < 0 && variant.destination &&
         !variant.asks_for_grasp;
}

Isometry3d ToolAtFocus(const SkillVariant& variant, const tasks::SceneState& state,
                       const Vector3d& across, double pitch) {
  const Focus& focus = *variant.focus;
  Isometry3d tool = Isometry3d::Identity();
  if (Pushes(variant)) {
    tool = ToolBehind(variant, state, across);
  } else if (focus.joint >= 0) {
    tool = ToolAtJoint(variant.model, state, focus);
    if (across.dot(tool.linear().col(1)) < 0.0) tool.linear().leftCols<2>() *= -1.0;
  } else {
    const Isometry3d& root = state.roots[static_cast<size_t>(focus.thing)];
    const tasks::Thing& taken = variant.model.things[static_cast<size_t>(focus.thing)];
    const double yaw = ThinDirection(taken, root, std::atan2(across.y(), across.x()));
    const Vector3d thin(std::cos(yaw), std::sin(yaw), 0.0), down(0.0, 0.0, -1.0);
    tool.linear() << thin.cross(down), thin, down;
    tool.translation() = root * focus.link_from_tool.translation() + focus.rim * thin;
    tool.translation().z() += Shallower(pitch, taken.height());
  }
  tool.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitY()));
  return tool;
}

std::optional<ReachPlan> PlanReach(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const robot::Posture& from,
                                   core::Rng& rng) {
  const Isometry3d& world_from_base = variant.subtask.start.world_from_robot;
  const Isometry3d tool_now = world_from_base * robot::ForwardKinematics(skill.robot->arm, from);
  const Vector3d across = tool_now.linear().col(1);
  const auto plan = [&](const Demands& demands) -> std::optional<ReachPlan> {
    for (const double pitch : PitchesOf(variant, demands)) {
      const auto stances = StancesWith(variant, state, across, pitch, demands);
      if (const auto found = PlanWith(skill, variant, state, from, stances, demands, rng)) {
        return found;
      }
    }
    return std::nullopt;
  };
  if (variant.room) {
    if (const auto found = plan({.looks_ahead = true, .leans_in = true})) return found;
  }
  if (variant.next) {
    if (const auto found = plan({.looks_ahead = true})) return found;
  }
  return plan({});
}

double PitchAt(const SkillVariant& variant, const tasks::SceneState& state,
               const Isometry3d& world_from_tool) {
  Vector3d up = state.roots[static_cast<size_t>(variant.focus->thing)].linear().col(2);
  if (up.z() < kUpright) up = Vector3d::UnitZ();
  const Vector3d axis = world_from_tool.linear().col(2);
  const Vector3d ahead = world_from_tool.linear().col(1).cross(-up).normalized();
  return std::atan2(axis.dot(ahead), -axis.dot(up));
}

}  // namespace simwright::rl
