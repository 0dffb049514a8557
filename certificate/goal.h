#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "certificate/placed_scene.h"

namespace simwright::certificate {

// The robot stands at -x of the furniture and looks along +x, as the viewer of relations does.
enum class GoalKind {
  kLift,     // held above its old place
  kInFront,  // held outside of the furniture, in front of it
  kPlace     // stands at one of several places, released
};

// The state of the target at the end of a task.
struct Goal {
  GoalKind kind = GoalKind::kLift;
  double lift = 0.05;  // m, kLift: the lowest point is at least this much higher than at the start
  double front = 0.0;  // m, kInFront: x of the furniture's front; the target's box is at lower x
  std::vector<Eigen::Isometry3d> places;  // kPlace: world_from_body, preferred first
  double place_tolerance = 0.03;          // m from one of the places
  double place_tilt = 0.26;               // rad of its vertical axis from that at the place

  // Returns true if the target at `now` is where the goal wants it; `start`: at the start.
  bool IsReached(const BodyModel& target, const Eigen::Isometry3d& start,
                 const Eigen::Isometry3d& now) const;
};

// Returns true if a body has boards one above the other: two parts that each cover half of its
// footprint, at least 10 cm apart.
bool IsShelf(const PlacedBody& furniture);

// Returns the goal of "bring OBJECT to the front": for an object in or on a shelf kInFront; for an
// object on other furniture kPlace, free places in the front quarter of what it stands on, nearest
// to the edge first. None if there is no such place, or the object stands on no furniture.
std::optional<Goal> FrontGoal(const PlacedScene& scene, int target);

// Returns the goal of "bring OBJECT to OTHER": free places on the same surface as `other`, with at
// most 5 cm between both, nearest to the robot's side first. None if there is no such place.
std::optional<Goal> BesideGoal(const PlacedScene& scene, int target, int other);

Goal LiftGoal();

}  // namespace simwright::certificate
