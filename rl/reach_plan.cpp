#include "rl/reach_plan.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "rl/arm_clearance.h"
#include "rl/joint_work.h"
#include "rl/observation.h"
#include "rl/posture_search.h"
#include "rl/tool_follower.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kFinger = 0.03;  // m behind what is pushed: fingers lean, walls lean out
// m: nearer to its goal a thing is pushed on as before. The hand would else have to go round it
// whenever it is past its goal.
constexpr double kThere = 0.03;
constexpr double kPitches[] = {0.0, 0.35, -0.35, 0.7, -0.7};
// Of a hand that pushes: leaning back it has its palm behind the thing, and not on top of it, so
// that the fingers push below the middle. Upright, the palm comes down on whatever is taller than
// the fingers are long.
constexpr double kPushPitches[] = {0.6, 0.8, 0.4};
// Of one that pushes a door shut: the door stands higher than the fingers are long.
constexpr double kShutPitches[] = {0.3, 0.6, 0.0, 0.9};
// Of a hand that goes into a room through its side: palm and wrist stay out of it, or below its
// ceiling. A microwave is 20 cm high inside; upright, hand and flange alone are 25.
constexpr double kRoomPitches[] = {0.8, 1.0, 0.6, 1.2};
// rad that fingers may be turned that push a door shut from where it stands wide open: to turn with
// it all that way is more than most wrists can.
constexpr double kPushTurned = 0.6;
constexpr double kLeaning = 0.9;  // of the lean, into the room: things with corners turn the hand
// That are looked at in rooms and along a joint's way: whether an arm is clear takes a millisecond.
constexpr int kLookedAt = 6;
// m a m, of a way over a rim: as fingers reach into a cup, over its width, and some more.
constexpr double kRise = 1.0;
constexpr double kPalmEdge = 0.04;  // m: what the edge comes down by, over 1 - cos(lean)
constexpr double kTurns[] = {0.25 * M_PI, 0.5 * M_PI, 0.75 * M_PI};  // of the fingers' line
constexpr double kSameLine = 0.97;  // the cosine of about 14 degrees

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
  bool clear = false;        // ReachPlan::clear
  bool round = false;        // or ReachPlan::via
  double margin = 0.0;       // m, WayWanted
  bool half = false;         // only the first half of a joint's way, the tool turned as it can be
};

// Whether the tool goes to `there` in variant.room through its opening, the arm being in nothing.
bool GoesIn(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
            const Isometry3d& there, ToolFollower* follower) {
  Isometry3d before = there;
  before.translation() += WayOutOfRoom(variant, state, there.translation());
  for (const Isometry3d& place : {before, there}) {
    if (!follower->Goes(place)) return false;
    const robot::Posture& arm = follower->posture();
    if (!IsArmClear(skill, variant, state, arm, variant.focus->thing)) return false;
  }
  return true;
}

// Whether a thing that is taken with the tool at `tool` can be brought where it shall go.
bool CarriesThing(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                  const Isometry3d& tool, const Demands& demands, ToolFollower* follower) {
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

// A posture in which the tool is at work.
struct Candidate {
  Isometry3d tool;  // world_from_tool
  double pitch = 0.0;
  robot::Posture posture;
  double seconds = 0.0;  // to get there, every joint at its highest speed
};

// Whether the tool goes the joint's way, and, where that is demanded, the arm, but for its fingers,
// is in nothing.
bool MovesJoint(const Skill& skill, const SkillVariant& variant, tasks::SceneState state,
                const Candidate& candidate, const Demands& demands, ToolFollower* follower) {
  const Focus& focus = *variant.focus;
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  Vector3d across = candidate.tool.linear().col(1);
  const std::vector<double> way =
      JointWay(variant.model.things[thing].joints[j], state.joints[thing][j]);
  const size_t followed = demands.half ? way.size() / 2 : way.size();
  const double turned = demands.half ? PushTurned(variant) : ToolFollower::kTurned;
  for (size_t i = 0; i < followed; ++i) {
    state.joints[thing][j] = way[i];
    const Isometry3d next = ToolAtFocus(variant, state, across, candidate.pitch);
    across = next.linear().col(1);
    if (!follower->Goes(next, turned)) return false;
    if (!demands.clear || i % 3 != 2) continue;  // half-way and at the end
    const ArmClearance clearance(skill, variant, state);
    if (!clearance.IsClear(follower->posture(), Fingers::kIgnored)) return false;
  }
  return true;
}

void AddCandidates(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                   const Stance& stance, const robot::Posture& from, core::Rng& rng,
                   std::vector<Candidate>* candidates) {
  const Isometry3d tool = ToolAtFocus(variant, state, stance.across, stance.pitch);
  for (const ReachingPosture& found : PosturesAt(skill, variant, tool, from, rng)) {
    candidates->push_back({tool, stance.pitch, found.posture, found.seconds});
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
  if (variant.focus->pushes) return kShutPitches;
  if (demands.leans_in) return kRoomPitches;
  return kPitches;
}

// For both sides of the hand, whose y axis is `across` now.
std::vector<Stance> StancesWith(const SkillVariant& variant, const tasks::SceneState& state,
                                const Vector3d& across, double pitch, const Demands& demands) {
  if (variant.focus->pushes) return {{across, pitch}};
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

// Into `before` (J) where the hand stays back before its work `at_work` (J), or as near to that as
// it gets. Whether it gets there: beside that place it would wait for ever.
bool StaysBack(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
               const robot::Posture& at_work, robot::Posture* before) {
  Isometry3d place =
      variant.subtask.start.world_from_robot * robot::ForwardKinematics(skill.robot->arm, at_work);
  Vector3d back = -skill.options.standoff * place.linear().col(2);
  if (variant.room && IsIn(*variant.room, variant.model, state, place.translation())) {
    back = WayOutOfRoom(variant, state, place.translation());
  }
  place.translation() += back;
  ToolFollower follower(skill, variant, at_work);
  const bool there = follower.Goes(place);
  *before = follower.posture();
  return there;
}

// How the arm gets from `from` to where the hand stays back before its work, in nothing at the work
// itself but for the fingers, which are about it: straight, or round what is between. None where
// it does not.
std::optional<Detour> WayThere(const Skill& skill, const SkillVariant& variant,
                               const tasks::SceneState& state, const robot::Posture& from,
                               const Candidate& candidate, const Demands& demands) {
  const bool takes = variant.focus->joint < 0;
  ArmClearance clearance(skill, variant, state, takes ? variant.focus->thing : -1);
  if (takes && !clearance.IsClear(candidate.posture)) return std::nullopt;
  const bool palm_free =
      Pushes(variant) ||
      ArmClearance(skill, variant, state).IsClear(candidate.posture, Fingers::kIgnored);
  robot::Posture before;
  if (!palm_free || !StaysBack(skill, variant, state, candidate.posture, &before)) {
    return std::nullopt;
  }
  if (demands.margin > 0.0) clearance.KeepOff(demands.margin, {from, before});
  if (clearance.IsWayClear(from, before)) return Detour();
  return demands.round ? PlanDetour(skill, clearance, from, before) : std::nullopt;
}

// The lines (unit, world) that the fingers may be along: `across`, and turned about the upright
// those that take a round thing otherwise.
std::vector<Vector3d> LinesAcross(const SkillVariant& variant, const tasks::SceneState& state,
                                  const Vector3d& across) {
  std::vector<Vector3d> lines = {across}, taken;
  if (variant.focus->joint >= 0 || Pushes(variant)) return lines;
  taken.push_back(ToolAtFocus(variant, state, across, 0.0).linear().col(1));
  for (const double turn : kTurns) {
    const Vector3d line = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * across;
    const Vector3d thin = ToolAtFocus(variant, state, line, 0.0).linear().col(1);
    const bool new_one = std::all_of(taken.begin(), taken.end(), [&](const Vector3d& other) {
      return std::abs(other.dot(thin)) < kSameLine;
    });
    if (!new_one) continue;
    taken.push_back(thin);
    lines.push_back(line);
  }
  return lines;
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
  const bool costs = variant.room || (variant.focus->joint >= 0 && demands.clear);
  if (costs && candidates.size() > kLookedAt) {
    candidates.erase(candidates.begin() + kLookedAt, candidates.end());
  }
  for (const Candidate& candidate : candidates) {
    ToolFollower follower(skill, variant, candidate.posture);
    const bool works =
        variant.focus->joint >= 0
            ? MovesJoint(skill, variant, state, candidate, demands, &follower)
            : CarriesThing(skill, variant, state, candidate.tool, demands, &follower);
    if (!works) continue;
    const bool goes_on = demands.looks_ahead && variant.next;
    if (!demands.clear) return ReachPlan{candidate.pitch, candidate.posture, false, {}, goes_on};
    const auto way = WayThere(skill, variant, state, from, candidate, demands);
    if (way) return ReachPlan{candidate.pitch, candidate.posture, way->empty(), *way, goes_on};
  }
  return std::nullopt;
}

}  // namespace

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
    if (!focus.pushes && across.dot(tool.linear().col(1)) < 0.0)
      tool.linear().leftCols<2>() *= -1.0;
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
                                   core::Rng& rng, const WayWanted& way) {
  const Isometry3d& world_from_base = variant.subtask.start.world_from_robot;
  const Isometry3d tool_now = world_from_base * robot::ForwardKinematics(skill.robot->arm, from);
  const std::vector<Vector3d> lines = LinesAcross(variant, state, tool_now.linear().col(1));
  const auto plan = [&](Demands demands) -> std::optional<ReachPlan> {
    demands.margin = way.margin;
    for (const double pitch : PitchesOf(variant, demands)) {
      for (size_t i = 0; i < (demands.clear && !demands.leans_in ? lines.size() : 1); ++i) {
        const auto stances = StancesWith(variant, state, lines[i], pitch, demands);
        if (const auto found = PlanWith(skill, variant, state, from, stances, demands, rng)) {
          return found;
        }
      }
    }
    return std::nullopt;
  };
  if (variant.room) {
    for (const bool clear : {true, false}) {
      const Demands demands{.looks_ahead = true, .leans_in = true, .clear = clear};
      if (const auto found = plan(demands)) return found;
    }
  }
  for (const bool clear : {true, false}) {
    if (variant.next) {
      if (const auto found = plan({.looks_ahead = true, .clear = clear})) return found;
    }
    if (const auto found = plan({.clear = clear})) return found;
    if (!clear || !way.round || variant.room) continue;
    if (const auto found = plan({.clear = true, .round = true})) return found;
    if (!way.part || !variant.focus->pushes) continue;
    const Demands half{.clear = true, .round = true, .half = true};
    if (const auto found = plan(half)) return found;
  }
  return std::nullopt;
}

Vector3d WayOutOfRoom(const SkillVariant& variant, const tasks::SceneState& state,
                      const Vector3d& point) {
  const double depth = std::max(0.0, DepthIn(*variant.room, variant.model, state, point));
  const Vector3d out = -InwardOf(*variant.room, variant.model, state);
  const bool over_rim = variant.focus->rim > 0.0 && !variant.starts_held;
  return (depth + kBeforeOpening) * (out + (over_rim ? kRise : 0.0) * Vector3d::UnitZ());
}

robot::Posture BeforeWork(const Skill& skill, const SkillVariant& variant,
                          const tasks::SceneState& state, const robot::Posture& at_work) {
  robot::Posture before;
  StaysBack(skill, variant, state, at_work, &before);
  return before;
}

double PushTurned(const SkillVariant& variant) {
  return variant.focus && variant.focus->pushes ? kPushTurned : ToolFollower::kTurned;
}

double PitchOf(const Isometry3d& world_from_tool) {
  const Vector3d axis = world_from_tool.linear().col(2);
  const Vector3d ahead = world_from_tool.linear().col(1).cross(-Vector3d::UnitZ()).normalized();
  return std::atan2(axis.dot(ahead), -axis.z());
}

}  // namespace simwright::rl
