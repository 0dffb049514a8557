#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rl/side_room.h"
#include "tasks/reward/reward_slot.h"
#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::rl {

// What the hand works on in a subtask: a part that a joint moves, or a thing.
struct Focus {
  int thing = -1, link = -1;
  int joint = -1;       // into Thing::joints; -1: the thing itself is moved
  bool pushes = false;  // the joint's part, with the tool's x along its way; else takes it
  // The tool's place at work: its z towards the link, its y across the link's thin side. Of a
  // thing without a joint only the origin counts; it is taken from above, wherever it is turned.
  Eigen::Isometry3d link_from_tool = Eigen::Isometry3d::Identity();
  // All such places at a part, the most natural first (ChooseApproach takes one).
  std::vector<Eigen::Isometry3d> approaches;
  // m from that origin to where a vessel that is too wide for the hand is taken: by its wall, on
  // the side that the tool's y points to. 0: in the middle.
  double rim = 0.0;
};

// Where the thing shall go, if the program says.
struct Destination {
  bool goal = false;          // to get_goal_pose
  int thing = -1, link = -1;  // else to this link: into its room where it has one, or onto it
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, the link's frame
  std::optional<SideRoom> room;                     // that it is in, where that opens to a side
  bool in_open_room = false;                        // it is in one that opens upwards
};

// What the program of a subtask works on, from what it reads: the joint whose state it takes, the
// thing whose grasp it asks for, else the thing or link whose place it takes. None where it names
// nothing. `opening`: m, how wide the hand opens; `base`: m, the height of the robot's base.
std::optional<Focus> FocusOf(const tasks::SceneModel& model, const tasks::SceneState& start,
                             const std::vector<tasks::RewardSlot>& slots, double opening,
                             double base);

std::optional<Destination> DestinationOf(const tasks::SceneModel& model,
                                         const tasks::SceneState& start, const Focus& focus,
                                         const std::vector<tasks::RewardSlot>& slots);

// world_from_tool at work on a focus with a joint.
Eigen::Isometry3d ToolAtJoint(const tasks::SceneModel& model, const tasks::SceneState& state,
                              const Focus& focus);

// The direction (rad about z, in [-pi/2, pi/2)) across the thinnest side of `thing` as it stands
// at `world_from_thing`, seen from above. Of directions within 2 mm of the thinnest the one nearest
// to `wished`: how a round thing is taken, does not matter.
double ThinDirection(const tasks::Thing& thing, const Eigen::Isometry3d& world_from_thing,
                     double wished);

// m, how wide `thing` is along `across` (unit, world).
double WidthAlong(const tasks::Thing& thing, const Eigen::Isometry3d& world_from_thing,
                  const Eigen::Vector3d& across);

}  // namespace simwright::rl
