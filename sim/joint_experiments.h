#pragma once

#include <set>
#include <string>

#include "sim/drop_test.h"
#include "sim/joint_rig.h"

namespace simwright::sim {

// How a hand would move a joint: slowly, with the force it takes.
struct JointDrive {
  double velocity = 0.0;   // rad/s or m/s: the whole range in one second
  double max_force = 0.0;  // N m or N
};

// Force for friction, weight (at its worst over the range) and damping, and to reach the velocity
// in a quarter of a second; never above `strongest_torque` (N m) or `strongest_force` (N).
JointDrive DriveFor(const ArticulatedBody& body, int joint, double strongest_torque = 60.0,
                    double strongest_force = 200.0);

// The greatest weight on a joint over its range, N m or N, absolute: friction above it holds.
double GreatestLoad(const ArticulatedBody& body, int joint);

struct SweepResult {
  double lowest = 0.0, highest = 0.0;  // rad or m: where the joint came to
  std::set<std::string> touching;      // pairs of links that touched on the way
};
// Drives one joint from its lower limit to the upper and back, at most 4 s each way; the others
// stand at zero.
SweepResult SweepJoint(const ArticulatedBody& body, int joint, JointRig* rig);

// How far the joint moves in `seconds`, let go at `position`; rad or m.
double DriftWhenLetGo(const ArticulatedBody& body, int joint, double position, double seconds,
                      JointRig* rig);

// Opens one joint of a thing that stands free on the floor and lets go: the greatest tilt of its
// root on the way and one second after, rad. The rig's root must be free.
double TiltWhenOpened(const ArticulatedBody& body, int joint, JointRig* rig);

// DropInBullet's experiment with a rig whose root is free; `whole` is all of it as one body.
DropResult DropRig(const RigidBody& whole, const DropOptions& options, JointRig* rig);

}  // namespace simwright::sim
