#include "sim/settling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "sim/drop_test.h"
#include "sim/max_displacement.h"
#include "sim/world.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

double Displacement(const RigidBody& body, double radius, const Isometry3d& from,
                    const Isometry3d& to) {
  return MaxDisplacement(body.inertial.center_of_mass, radius, from, to);
}

void Load(const std::vector<SettlingBody>& bodies, World* world) {
  for (const SettlingBody& one : bodies) {
    if (!one.body) throw core::Error("an object to settle needs a body");
    if (!one.world_from_body.matrix().allFinite()) {
      throw core::Error("its pose is not finite", one.body->name);
    }
    one.fixed ? world->AddFixed(*one.body, one.world_from_body)
              : world->Add(*one.body, one.world_from_body);
  }
}

bool HasFallen(const SettlingBody& one, const Isometry3d& now, double fallen) {
  const Vector3d& center = one.body->inertial.center_of_mass;
  return (one.world_from_body * center - now * center).z() > fallen;
}

// Returns the result for a free body after settling.
SettledBody ResultOf(const SettlingBody& one, const Isometry3d& now, double fallen) {
  SettledBody end;
  end.world_from_body = now;
  end.moved = Displacement(*one.body, Radius(*one.body), one.world_from_body, now);
  end.tilted = TiltBetween(one.world_from_body, now);
  end.fell = HasFallen(one, now, fallen);
  return end;
}

constexpr double kFloorReach = 0.05;     // m
constexpr double kCheckInterval = 0.05;  // s between two checks
constexpr double kRestInterval = 0.1;    // s without motion: at rest
constexpr double kShortestCheck = 0.25;  // s

// A world with the bodies of a scene, stepped until they rest and then checked for stability.
class Simulation {
 public:
  Simulation(const std::vector<SettlingBody>& bodies, const SettlingOptions& options)
      : bodies_(bodies), options_(options), world_(OptionsOf(options)), removed_(bodies.size(), 0) {
    Load(bodies, &world_);
    for (const SettlingBody& one : bodies) radii_.push_back(Radius(*one.body));
  }

  std::vector<SettledBody> Run() {
    world_.ScaleFriction(options_.settling_friction);
    Settle();
    world_.ScaleFriction(1.0);
    std::vector<SettledBody> settled;
    for (size_t i = 0; i < bodies_.size(); ++i) {
      SettledBody stays;
      stays.world_from_body = bodies_[i].world_from_body;
      settled.push_back(bodies_[i].fixed ? stays
                                         : ResultOf(bodies_[i], PoseOf(i), options_.fall_distance));
    }
    world_.ZeroVelocities();  // cached contact impulses may hold an object that slips without them
    CheckStability(&settled);
    for (size_t i = 0; i < settled.size(); ++i) {
      if (removed_[i]) settled[i].drift = HUGE_VAL;
      settled[i].stable = settled[i].drift <= options_.stable;
    }
    return settled;
  }

 private:
  static WorldOptions OptionsOf(const SettlingOptions& options) {
    WorldOptions world;
    world.time_step = options.time_step;
    world.solver_iterations = options.solver_iterations;
    world.full_warm_start = true;
    world.floor_reach = kFloorReach;
    return world;
  }

  Isometry3d PoseOf(size_t body) const { return world_.Pose(static_cast<int>(body)); }

  void Step(double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / options_.time_step));
    for (int i = 0; i < std::max(1, steps); ++i) world_.Step();
  }

  // Returns the largest displacement of any free body; HUGE_VAL if one is not finite.
  double LargestDisplacement(const std::vector<Isometry3d>& poses) const {
    double farthest = 0.0;
    for (size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].fixed || removed_[i]) continue;
      const double displacement = Displacement(*bodies_[i].body, radii_[i], poses[i], PoseOf(i));
      farthest = std::isfinite(displacement) ? std::max(farthest, displacement) : HUGE_VAL;
    }
    return farthest;
  }

  std::vector<Isometry3d> Poses() const {
    std::vector<Isometry3d> poses;
    for (size_t i = 0; i < bodies_.size(); ++i) poses.push_back(PoseOf(i));
    return poses;
  }

  void RemoveFallen() {
    for (size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].fixed || removed_[i]) continue;
      removed_[i] = HasFallen(bodies_[i], PoseOf(i), options_.fall_distance);
      if (removed_[i]) world_.Remove(static_cast<int>(i));
    }
  }

  // Tilts gravity once around, then restores it.
  void TiltGravity() {
    const double down = WorldOptions().gravity;
    const int steps =
        static_cast<int>(std::lround(options_.gravity_tilt_time / options_.time_step));
    for (int i = 0; i < steps; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / steps,
                   aside = std::sin(options_.gravity_tilt);
      world_.SetGravity(down * Vector3d(aside * std::cos(turn), aside * std::sin(turn),
                                        -std::cos(options_.gravity_tilt)));
      world_.Step();
    }
    world_.SetGravity({0.0, 0.0, -down});
  }

  void Settle() {
    double elapsed = 0.0;
    if (options_.gravity_tilt > 0.0 && options_.gravity_tilt_time < options_.duration) {
      TiltGravity();
      elapsed = options_.gravity_tilt_time;
    }
    std::vector<Isometry3d> before = Poses();
    while (elapsed < options_.duration - 1e-9) {
      const double interval = std::min(kRestInterval, options_.duration - elapsed);
      Step(interval);
      elapsed += interval;
      if (options_.rest_tolerance > 0.0) {
        RemoveFallen();
        if (LargestDisplacement(before) <= options_.rest_tolerance) return;
      }
      before = Poses();
    }
  }

  void CheckStability(std::vector<SettledBody>* settled) {
    double elapsed = 0.0, farthest = 0.0;
    while (elapsed < options_.watch - 1e-9) {
      const double interval = std::min(kCheckInterval, options_.watch - elapsed);
      Step(interval);
      elapsed += interval;
      for (size_t i = 0; i < bodies_.size(); ++i) {
        if (bodies_[i].fixed || removed_[i]) continue;
        SettledBody& one = (*settled)[i];
        const double displacement =
            Displacement(*bodies_[i].body, radii_[i], one.world_from_body, PoseOf(i));
        one.drift = std::isfinite(displacement) ? std::max(one.drift, displacement) : HUGE_VAL;
        farthest = std::max(farthest, one.drift);
      }
      const double rest = options_.watch / elapsed;
      const double early_stop_factor =
          1.0 + (options_.early_stop_factor - 1.0) * (1.0 - elapsed / options_.watch);
      const bool still = elapsed >= kShortestCheck - 1e-9 &&
                         farthest * rest * early_stop_factor <= options_.stable;
      const bool decided = still || farthest > options_.stable;
      if (options_.early_stop_factor <= 0.0 || !decided) continue;
      for (SettledBody& one : *settled) one.drift *= rest;
      return;
    }
  }

  const std::vector<SettlingBody>& bodies_;
  const SettlingOptions& options_;
  World world_;
  std::vector<char> removed_;
  std::vector<double> radii_;
};

}  // namespace

bool SettlingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!(duration >= 0.0) || duration > 3600.0) return fails("duration must be 0 to 3600 s");
  if (!(watch >= 0.0) || watch > 3600.0) return fails("watch must be 0 to 3600 s");
  if (!(time_step > 0.0) || time_step > 0.02) {
    return fails("time_step must be above 0 and at most 0.02 s");
  }
  if (solver_iterations < 1) return fails("solver_iterations must be at least 1");
  if (!(gravity_tilt >= 0.0) || gravity_tilt > 0.5)
    return fails("gravity_tilt must be 0 to 0.5 rad");
  if (!(settling_friction >= 0.0) || settling_friction > 10.0) {
    return fails("settling_friction must be 0 to 10");
  }
  if (!(gravity_tilt_time >= 0.0)) return fails("gravity_tilt_time must be at least 0 s");
  if (!(stable > 0.0)) return fails("stable must be above 0 m");
  if (!(rest_tolerance >= 0.0)) return fails("rest_tolerance must be at least 0 m");
  if (!(early_stop_factor >= 0.0)) return fails("early_stop_factor must be at least 0");
  if (!(fall_distance > 0.0)) return fails("fall_distance must be above 0 m");
  return true;
}

std::vector<SettledBody> Settle(const std::vector<SettlingBody>& bodies,
                                const SettlingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("settling: " + error);
  return Simulation(bodies, options).Run();
}

}  // namespace simwright::sim
