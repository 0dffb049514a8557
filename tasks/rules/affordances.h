#pragma once

#include "tasks/thing.h"

namespace simwright::tasks {

// What moving a joint is called.
enum class JointUse {
  kNone,    // not for a hand: too small a range, or it follows another
  kOpen,    // open / close: doors, drawers, lids, sashes, screens
  kSlide,   // slide open / slide closed: sashes, sliding doors
  kTurn,    // turn on / turn off: knobs, taps, valves
  kSwitch,  // switch on / switch off
  kLatch,   // turn / turn back: a door's own handle
  kPress,   // press: buttons, keys, a toaster's lever
};

// By the label of what it moves (semantics.txt), without one by the link's name, its type and
// range: what turns by more than 0.6 rad or slides by more than 6 cm opens, what slides less is
// pressed.
JointUse UseOf(const Thing& thing, const ThingJoint& joint);

// "door", "drawer 2", "lid": what a person would call what the joint moves.
std::string PartName(const Thing& thing, const ThingJoint& joint);

// What one hand takes: a Panda's, whose fingers open by 8 cm and whose payload is 3 kg, with some
// to spare.
constexpr double kHandOpening = 0.075;  // m
constexpr double kPayload = 2.5;        // kg

// Whether it has a part that a hand closes around and that stands out: a hammer's shaft, the handle
// of a teapot. Its shapes tell: a slim one that reaches 2 cm beyond those that are not slim, or,
// where all are, a rod at least twice as long as wide.
bool HasHandle(const Thing& thing);

// Whether one hand lifts it: narrow enough somewhere, or with a rim or a handle to take.
bool CanBeLifted(const Thing& thing);

// Why no hand does anything with a thing, a sentence and what may mend it; empty where one can.
struct NoUse {
  std::string sentence, remedy;
};
NoUse WhyOfNoUse(const Thing& thing);

// Whether a hand can push it along the floor: rigid, higher than 2 cm, at most 8 kg.
bool CanBePushed(const Thing& thing);

// Whether it holds what can be poured: open above or called so (a teapot), and can be lifted.
bool CanPour(const Thing& thing);

// Whether `thing` stands on top of `holder`: a level top, larger than its foot.
bool StandsOn(const Thing& thing, const Thing& holder);

// Whether `thing` fits the cavity of `holder` as it stands, with a centimetre to spare.
bool FitsInto(const Thing& thing, const Thing& holder, int cavity);

}  // namespace simwright::tasks
