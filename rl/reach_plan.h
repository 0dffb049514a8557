#pragma once

#include <optional>

#include "rl/detour.h"
#include "rl/skill.h"

namespace simwright::rl {

// Whether the thing is brought to its destination without being grasped.
bool Pushes(const SkillVariant& variant);

// world_from_tool at work: on the focus, or where it is pushed, behind it as seen from its
// destination. `across` (unit, world): the tool's y axis, the line from
// finger to finger, as it is now; the hand is the same turned by half about its own axis, and stays
// near it. `pitch` (rad): the hand leans by so much about that line, about which a bar may be taken
// anyhow.
Eigen::Isometry3d ToolAtFocus(const SkillVariant& variant, const tasks::SceneState& state,
                              const Eigen::Vector3d& across, double pitch);

// How an arm does its work.
struct ReachPlan {
  double pitch = 0.0;      // rad, of the hand
  robot::Posture at_work;  // (J) with the tool at the focus
  bool clear = false;      // the arm is in nothing on its way there, straight from joint to joint
  Detour via;              // else round what is between, to where it waits; empty: none found
  bool goes_on = false;    // what is taken can go on to variant.next

  bool GetsThere() const { return clear || !via.empty(); }
};

// Of the arm's way to where it waits.
struct WayWanted {
  bool round = false;   // ReachPlan::via, where no plan is clear
  bool part = false;    // and where there is none: one for the first half of what is pushed shut
  double margin = 0.0;  // m that it keeps off things half-way (ArmClearance::KeepOff)
};

// The least pitch (of a hand that pushes: about 0.6 rad; of one that goes into a room through its
// side: about 0.8, leaning into it), and of some postures the one soonest reached from `from`, from
// which the tool goes along most of the joint's way, or with the thing to its destination, off by
// no more than a centimetre and 0.15 rad, and the arm is in nothing in a room and before it. One
// that is clear, where there is one: round things are taken with the fingers' line any way for it.
// A thing is taken so that it can go on to variant.next too, where there is a way. `way`.round:
// where no plan is clear, one to whose work the arm gets round what is between. None where no pitch
// does. Postures are sought for both sides of the hand, from `from` and from random ones: a tool
// that only ever goes straight at its target ends at some joint's limit every other time.
std::optional<ReachPlan> PlanReach(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const robot::Posture& from,
                                   core::Rng& rng, const WayWanted& way = {});

// m, world: how a hand at `point` in variant.room goes out of it to before the opening. Straight,
// or from a rim that it takes, one finger being inside: upwards as well, and so it comes in.
Eigen::Vector3d WayOutOfRoom(const SkillVariant& variant, const tasks::SceneState& state,
                             const Eigen::Vector3d& point);

// (J) in which the hand stays back before its work `at_work` (J).
robot::Posture BeforeWork(const Skill& skill, const SkillVariant& variant,
                          const tasks::SceneState& state, const robot::Posture& at_work);

// rad that the tool may be turned as it moves the part that the skill works on: more where fingers
// push a door or lid shut (Focus::pushes).
double PushTurned(const SkillVariant& variant);

// rad that the hand at `world_from_tool` leans about its own y axis, as PlanReach's pitch.
double PitchOf(const Eigen::Isometry3d& world_from_tool);

}  // namespace simwright::rl
