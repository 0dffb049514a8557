#include "sim/settling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "sim/drop_test.h"
#include "sim/point_way.h"
#include "sim/world.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

double Way(const RigidBody& body, double radius, const Isometry3d& from, const Isometry3d& to) {
  return FarthestWay(body.inertial.center_of_mass, radius, from, to);
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

bool HasFallen(const SettlingBody& one, const Isometry3d& now, double fallen) {
  const Vector3d& center = one.body->inertial.center_of_mass;
  return (one.world_from_body * center - now * center).z() > fallen;
}

// Where a free body is once it has settled.
SettledBody EndOf(const SettlingBody& one, const Isometry3d& now, double fallen) {
  SettledBody end;
  end.world_from_body = now;
  end.moved = Way(*one.body, Radius(*one.body), one.world_from_body, now);
  end.tilted = TiltBetween(one.world_from_body, now);
  end.fell = HasFallen(one, now, fallen);
  return end;
}

constexpr double kFloorReach = 0.05;    // m
constexpr double kLook = 0.05;          // s between two looks
constexpr double kRestFor = 0.1;        // s without a motion: at rest
constexpr double kWatchAtLeast = 0.25;  // s

// A world with the things of a scene in it, stepped until they rest and then watched.
class Scene {
 public:
  Scene(const std::vector<SettlingBody>& bodies, const SettlingOptions& options)
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
      settled.push_back(bodies_[i].fixed ? stays : EndOf(bodies_[i], PoseOf(i), options_.fallen));
    }
    world_.Rest();  // what contacts have learned on the way may hold what slips without
    Watch(&settled);
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
    world.firm_contacts = true;
    world.floor_reach = kFloorReach;
    return world;
  }

  Isometry3d PoseOf(size_t body) const { return world_.Pose(static_cast<int>(body)); }

  void Step(double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / options_.time_step));
    for (int i = 0; i < std::max(1, steps); ++i) world_.Step();
  }

  // The farthest that any free body is from where it was; HUGE_VAL where one is nowhere.
  double FarthestFrom(const std::vector<Isometry3d>& poses) const {
    double farthest = 0.0;
    for (size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i].fixed || removed_[i]) continue;
      const double way = Way(*bodies_[i].body, radii_[i], poses[i], PoseOf(i));
      farthest = std::isfinite(way) ? std::max(farthest, way) : HUGE_VAL;
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
      removed_[i] = HasFallen(bodies_[i], PoseOf(i), options_.fallen);
      if (removed_[i]) world_.Remove(static_cast<int>(i));
    }
  }

  // Leaves gravity as it was.
  void Sway() {
    const double down = WorldOptions().gravity;
    const int steps = static_cast<int>(std::lround(options_.sway_time / options_.time_step));
    for (int i = 0; i < steps; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / steps, aside = std::sin(options_.sway);
      world_.SetGravity(down * Vector3d(aside * std::cos(turn), aside * std::sin(turn),
                                        -std::cos(options_.sway)));
      world_.Step();
    }
    world_.SetGravity({0.0, 0.0, -down});
  }

  void Settle() {
    double passed = 0.0;
    if (options_.sway > 0.0 && options_.sway_time < options_.duration) {
      Sway();
      passed = options_.sway_time;
    }
    std::vector<Isometry3d> before = Poses();
    while (passed < options_.duration - 1e-9) {
      const double some = std::min(kRestFor, options_.duration - passed);
      Step(some);
      passed += some;
      if (options_.resting > 0.0) {
        RemoveFallen();
        if (FarthestFrom(before) <= options_.resting) return;
      }
      before = Poses();
    }
  }

  void Watch(std::vector<SettledBody>* settled) {
    double passed = 0.0, farthest = 0.0;
    while (passed < options_.watch - 1e-9) {
      const double some = std::min(kLook, options_.watch - passed);
      Step(some);
      passed += some;
      for (size_t i = 0; i < bodies_.size(); ++i) {
        if (bodies_[i].fixed || removed_[i]) continue;
        SettledBody& one = (*settled)[i];
        const double way = Way(*bodies_[i].body, radii_[i], one.world_from_body, PoseOf(i));
        one.drift = std::isfinite(way) ? std::max(one.drift, way) : HUGE_VAL;
        farthest = std::max(farthest, one.drift);
      }
      const double rest = options_.watch / passed;
      const double pace = 1.0 + (options_.pace - 1.0) * (1.0 - passed / options_.watch);
      const bool still =
          passed >= kWatchAtLeast - 1e-9 && farthest * rest * pace <= options_.stable;
      const bool decided = still || farthest > options_.stable;
      if (options_.pace <= 0.0 || !decided) continue;
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
  if (!(duration >= 0.0) || duration > 3600.0) return fails("duration has to be 0 to 3600 s");
  if (!(watch >= 0.0) || watch > 3600.0) return fails("watch has to be 0 to 3600 s");
  if (!(time_step > 0.0) || time_step > 0.02) return fails("time_step has to be 0 to 0.02 s");
  if (solver_iterations < 1) return fails("solver_iterations has to be at least 1");
  if (!(sway >= 0.0) || sway > 0.5) return fails("sway has to be 0 to 0.5 rad");
  if (!(settling_friction >= 0.0) || settling_friction > 10.0) {
    return fails("settling_friction has to be 0 to 10");
  }
  if (!(sway_time >= 0.0)) return fails("sway_time has to be at least 0 s");
  if (!(stable > 0.0)) return fails("stable has to be above 0 m");
  if (!(resting >= 0.0)) return fails("resting has to be at least 0 m");
  if (!(pace >= 0.0)) return fails("pace has to be at least 0");
  if (!(fallen > 0.0)) return fails("fallen has to be above 0 m");
  return true;
}

std::vector<SettledBody> Settle(const std::vector<SettlingBody>& bodies,
                                const SettlingOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("settling: " + error);
  return Scene(bodies, options).Run();
}

}  // namespace simwright::sim
