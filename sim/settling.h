#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

// A thing of a scene that is left to gravity.
struct SettlingBody {
  const RigidBody* body = nullptr;  // not null; may be shared
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;  // welded furniture
};

struct SettlingOptions {
  double duration = 2.5;  // s: what is off by millimetres has come to rest after that
  double watch = 2.0;     // s, after it: what moves then is not stable
  // rad by which gravity leans, once round, in the first `sway_time` (s): what balances tips.
  double sway = 0.0;
  double sway_time = 0.1;
  // Share of their friction that things have until they are watched: below 1, what then rests has
  // friction to spare.
  double settling_friction = 1.0;
  // s. Towers of five stand still at 1 ms; at 240 Hz the upper ones creep.
  double time_step = 1e-3;
  int solver_iterations = 50;
  double stable = 1e-3;  // m that no point of a stable thing moves while it is watched
  // m that nothing moves over 0.1 s: then all has settled, whatever is left of `duration`; 0: never
  // before it has passed. At that pace a thing would be at the limit of `stable` when it has been
  // watched: whether it creeps on, watching finds.
  double resting = 5e-5;
  // Watching ends after a quarter of a second or more where ways so far would stay below `stable` to
  // the end, at a multiple of their pace: this one at first, less the less there is to come, 1 at the
  // end; and wherever one has moved by more. 0: never before `watch` has passed.
  double pace = 4.0;
  // m below where it began: what is lower has fallen off what it stood on. It is taken out, so that
  // it knocks nothing down and nobody waits for it to roll to rest; not where `resting` is 0.
  double fallen = 0.05;

  bool IsValid(std::string* error) const;
};

// What became of it. A point's way is that of its centre of mass, and of the body's farthest vertex
// as it turns.
struct SettledBody {
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  // when it had settled
  double moved = 0.0;   // m, from the beginning to then
  double tilted = 0.0;  // rad, its upright from its first one
  // m, the farthest it was from there while it was watched; where that ended early, at the same
  // pace to the end. Of what was taken out, HUGE_VAL.
  double drift = 0.0;
  bool fell = false;    // lower than it began, by more than `fallen`
  bool stable = false;  // drift <= options.stable
};

// Lets things fall and slide in Bullet, over the floor z = 0, until they rest; then watches them,
// from a start without speed, or contacts that are known already, as whoever loads them will see
// them. In the order of `bodies`; what is fixed is as it was. Repeatable bit for bit. Throws
// core::Error for options that are not valid, a free body without a mass, or poses that are not
// finite.
std::vector<SettledBody> Settle(const std::vector<SettlingBody>& bodies,
                                const SettlingOptions& options = {});

}  // namespace simwright::sim
