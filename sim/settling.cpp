#include "sim/settling.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/drop_test.h"
#include "sim/world.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// m that any point of the body, no farther than `radius` from its centre of mass, has moved by.
double Way(const RigidBody& body, double radius, const Isometry3d& from, const Isometry3d& to) {
  const Vector3d& center = body.inertial.center_of_mass;
  const double turn = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (to * center - from * center).norm() + 2.0 * radius * std::sin(0.5 * turn);
}

void Load(const std::vector<SettlingBody>& bodies, World* world) {
  for (const SettlingBody& one : bodies) {
    if (!one.body) throw core::Error("a thing that settles needs a body");
    if (!one.world_from_body.matrix().allFinite()) {
      throw core::Error("its pose is not finite", one.body->name);
    }
    one.fixed ? world->AddFixed(*one.body, one.world_from_body)
              : world->Add(*one.body, one.world_from_body);
  }
}

// Where a free body is once it has settled.
SettledBody EndOf(const SettlingBody& one, const Isometry3d& now, double fallen) {
  const Vector3d& center = one.body->inertial.center_of_mass;
  SettledBody end;
  end.world_from_body = now;
  end.moved = Way(*one.body, Radius(*one.body), one.world_from_body, now);
  end.tilted = TiltBetween(one.world_from_body, now);
  end.fell = (one.world_from_body * center - now * center).z() > fallen;
  return end;
}

}  // namespace

bool SettlingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(duration >= 0.0) || duration > 3600.0) return fails("duration has to be 0 to 3600 s");
  if (!(watch >= 0.0) || watch > 3600.0) return fails("watch has to be 0 to 3600 s");
  if (!(time_step > 0.0) || time_step > 0.02) return fails("time_step has to be 0 to 0.02 s");
  if (solver_iterations < 1) return fails("solver_iterations has to be at least 1");
  if (!(stable > 0.0)) return fails("stable has to be above 0 m");
  if (!(fallen > 0.0)) return fails("fallen has to be above 0 m");
  return true;
}

std::vector<SettledBody> Settle(const std::vector<SettlingBody>& bodies,
                                const SettlingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("settling: " + error);
  WorldOptions world_options;
  world_options.time_step = options.time_step;
  world_options.solver_iterations = options.solver_iterations;
  World world(world_options);
  Load(bodies, &world);
  const auto run = [&](double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / options.time_step));
    for (int i = 0; i < steps; ++i) world.Step();
  };
  run(options.duration);
  std::vector<SettledBody> settled;
  for (size_t i = 0; i < bodies.size(); ++i) {
    SettledBody stays;
    stays.world_from_body = bodies[i].world_from_body;
    const int index = static_cast<int>(i);
    settled.push_back(bodies[i].fixed ? stays
                                      : EndOf(bodies[i], world.Pose(index), options.fallen));
  }
  constexpr double kLook = 0.05;  // s between two looks
  for (double watched = 0.0; watched < options.watch - 1e-9; watched += kLook) {
    run(std::min(kLook, options.watch - watched));
    for (size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].fixed) continue;
      const double way = Way(*bodies[i].body, Radius(*bodies[i].body), settled[i].world_from_body,
                             world.Pose(static_cast<int>(i)));
      settled[i].drift = std::isfinite(way) ? std::max(settled[i].drift, way) : HUGE_VAL;
    }
  }
  for (SettledBody& end : settled) end.stable = end.drift <= options.stable;
  return settled;
}

}  // namespace simwright::sim
