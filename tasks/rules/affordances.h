#pragma once

#include "tasks/articulated_object.h"

namespace simwright::tasks {

// The kind of interaction that moves a joint; it determines the words for the task.
enum class JointUse {
  kNone,    // not operated by the gripper: too small a range, or it follows another joint
  kOpen,    // open / close: doors, drawers, lids, sashes, screens
  kSlide,   // slide open / slide closed: sashes, sliding doors
  kTurn,    // turn on / turn off: knobs, taps, valves
  kSwitch,  // switch on / switch off
  kLatch,   // turn / turn back: a door's handle
  kPress,   // press: buttons, keys, a toaster's lever
};

// Returns the joint's use by the label of the part that it moves (semantics.txt). Without a label,
// uses the link's name and the joint's type and range: a joint that turns by more than 0.6 rad or
// slides by more than 6 cm opens, one that slides less is pressed.
JointUse GetJointUse(const ArticulatedObject& object, const ObjectJoint& joint);

// Returns the spoken name of the part that the joint moves: "door", "drawer 2", "lid".
std::string PartName(const ArticulatedObject& object, const ObjectJoint& joint);

// The limits of what the gripper can grasp: those of a Panda, whose fingers open by 8 cm and whose
// payload is 3 kg, with a margin.
constexpr double kMaxGraspWidth = 0.075;  // m
constexpr double kPayload = 2.5;          // kg

// Returns true if the object has a protruding part that the gripper can close around, such as a
// hammer's shaft or the handle of a teapot. The test uses its shapes: a slim shape that extends 2
// cm beyond those that are not slim, or, where all are slim, a rod at least twice as long as wide.
bool HasHandle(const ArticulatedObject& object);

// Returns true if one gripper can lift the object: a proved grasp takes it off its support
// (ArticulatedObject::graspable). Without known grasps: it is narrow enough somewhere, or has a
// graspable rim or handle.
bool CanBeLifted(const ArticulatedObject& object);

// The reason why the gripper can do nothing with an object, as a sentence and a possible remedy;
// empty where it can.
struct UnusableReason {
  std::string sentence, remedy;
};
UnusableReason ExplainUnusable(const ArticulatedObject& object);

// Returns true if the gripper can push the object along the floor: rigid, higher than 2 cm, at most
// 8 kg.
bool CanBePushed(const ArticulatedObject& object);

// Returns true if the object can be poured from: it opens upwards or has the name of such an object
// (a teapot), and it can be lifted.
bool CanPour(const ArticulatedObject& object);

// Returns true if `object` can stand on top of `holder`: its top is level and larger than the
// footprint of `object`.
bool CanStandOn(const ArticulatedObject& object, const ArticulatedObject& holder);

// Returns true if `object` fits into the receptacle of `holder` in its rest pose, with a margin of
// 1 cm.
bool FitsInto(const ArticulatedObject& object, const ArticulatedObject& holder, int receptacle);

}  // namespace simwright::tasks
