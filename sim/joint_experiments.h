#pragma once

#include <set>
#include <string>

#include "sim/drop_test.h"
#include "sim/joint_rig.h"

namespace simwright::sim {

// The motor that moves a joint in an experiment: slowly, with the force it takes.
struct JointDrive {
  double velocity = 0.0;   // rad/s or m/s: the full range in one second
  double max_force = 0.0;  // N m or N
};

// Returns a drive with the force for friction, weight (the largest over the range), damping and
// acceleration to the velocity in a quarter of a second; at most `strongest_torque` (N m) or
// `strongest_force` (N).
JointDrive DriveFor(const ArticulatedBody& body, int joint, double strongest_torque = 60.0,
                    double strongest_force = 200.0);

// Returns the largest gravity load on a joint over its range, N m or N, absolute: a larger friction
// holds it.
double GreatestLoad(const ArticulatedBody& body, int joint);

struct SweepResult {
  double lowest = 0.0, highest = 0.0;  // rad or m: the range that the joint reached
  std::set<std::string> touching;      // pairs of links that touched during the motion
};
// Drives one joint from its lower limit to the upper and back, at most 4 s each; the others start
// at zero.
SweepResult SweepJoint(const ArticulatedBody& body, int joint, JointRig* rig);

// Returns how far the joint moves in `seconds` after its release at `position`; rad or m.
double DriftAfterRelease(const ArticulatedBody& body, int joint, double position, double seconds,
                         JointRig* rig);

// Opens one joint of a body that stands free on the floor and releases it: returns the largest tilt
// of its root until one second after, rad. The rig's root must be free.
double TiltWhenOpened(const ArticulatedBody& body, int joint, JointRig* rig);

// Runs DropInBullet's experiment with a rig whose root is free; `whole` is all of it as one body.
DropResult DropRig(const RigidBody& whole, const DropOptions& options, JointRig* rig);

}  // namespace simwright::sim
