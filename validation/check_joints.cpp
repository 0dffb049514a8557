#include "validation/check_joints.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "assets/joint_gravity_load.h"
#include "core/error.h"
#include "sim/joint_experiments.h"
#include "sim/joint_rig.h"
#include "validation/joint_clearance.h"
#include "validation/shared_results.h"

namespace simwright::validation {
namespace {

constexpr double kLeastClearance = 1e-4;  // m: the sum of both hulls' margins in Bullet
constexpr double kHoldSeconds = 1.0;
constexpr double kTippingShare = 0.01;  // of the total mass: lighter links tip nothing

double RangeOf(const assets::Joint& joint) {
  return joint.type == assets::JointType::kContinuous ? 2.0 * M_PI : joint.upper - joint.lower;
}

bool CanBeTried(const assets::Joint& joint) {
  return joint.Moves() && !joint.mimic && RangeOf(joint) > 0.0;
}

void AddClearanceRow(const assets::UrdfModel& model, int joint, bool fixed, CheckResults* results) {
  const std::string& name = model.joints[static_cast<size_t>(joint)].name;
  const Clearance alone = SweptClearance(model, joint, false);
  const auto moving = std::count_if(model.joints.begin(), model.joints.end(),
                                    [](const assets::Joint& j) { return j.Moves(); });
  const Clearance others_up = moving > 1 ? SweptClearance(model, joint, true) : alone;
  const bool free = alone.distance >= kLeastClearance;
  const Clearance& least = free && others_up.distance < kLeastClearance ? others_up : alone;
  if (!std::isfinite(least.distance)) {
    results->Report("clearance-" + name, 0.0, "no link is near enough to touch");
  } else if (free && others_up.distance < kLeastClearance) {
    // Two open doors may collide, as real ones do.
    results->Add("clearance-" + name, core::Severity::kWarning, least.distance * 1e3,
                 "mm between " + least.pair +
                     ", minimum over the range with other joints open, "
                     "at least 0.1");
  } else {
    results->Require("clearance-" + name, free, least.distance * 1e3,
                     "mm between " + least.pair + ", minimum over the range, at least 0.1");
  }
  if (fixed) return;
  const double lowest = LowestOnSweep(model, joint);
  if (!std::isfinite(lowest)) {
    results->Report("above-floor-" + name, 0.0, "the asset stands on the links that it carries");
    return;
  }
  results->Require("above-floor-" + name, lowest > 0.0, lowest * 1e3,
                   "mm above the floor, minimum over the range, above 0");
}

// Returns how far the sweep reached towards both limits, as a fraction of the range.
double Reach(const assets::Joint& joint, const sim::SweepResult& sweep) {
  const double range = RangeOf(joint);
  const double lower = joint.type == assets::JointType::kContinuous ? 0.0 : joint.lower;
  return std::min((sweep.highest - lower) / range, 1.0 - (sweep.lowest - lower) / range);
}

void AddSwingRow(const sim::ArticulatedBody& body, int joint, const std::string& engine,
                 bool contacts_fail, const CheckLimits& limits, sim::JointRig* rig,
                 CheckResults* results) {
  const assets::Joint& j = body.joints()[static_cast<size_t>(joint)];
  const sim::SweepResult sweep = sim::SweepJoint(body, joint, rig);
  const double reach = Reach(j, sweep);
  const std::string code = "swings-" + engine + "-" + j.name;
  if (contacts_fail && !sweep.touching.empty()) {
    results->Require(code, false, reach, "of its range: " + *sweep.touching.begin() + " touch");
    return;
  }
  results->Require(code, reach >= limits.joint_reach, reach,
                   "of its range up and back, at least 0.99, driven by a human's force");
}

double GreatestDrift(const sim::ArticulatedBody& body, int joint, sim::JointRig* rig) {
  const assets::Joint& j = body.joints()[static_cast<size_t>(joint)];
  double drift = 0.0;
  for (const double share : {0.0, 0.5, 1.0}) {
    const double position = j.lower + share * (j.upper - j.lower);
    drift = std::max(drift, sim::DriftAfterRelease(body, joint, position, kHoldSeconds, rig));
  }
  return drift / RangeOf(j);
}

void AddEngineRows(const sim::ArticulatedBody& body, const std::string& engine,
                   const CheckLimits& limits, sim::JointRig* held, sim::JointRig* free,
                   CheckResults* results) {
  double whole = 0.0;
  for (const sim::RigidBody& link : body.links) whole += link.inertial.mass;
  for (const int joint : body.kinematics->moving_joints()) {
    const assets::Joint& j = body.joints()[static_cast<size_t>(joint)];
    if (!CanBeTried(j)) continue;
    AddSwingRow(body, joint, engine, true, limits, held, results);
    results->AtMost("holds-" + engine + "-" + j.name, GreatestDrift(body, joint, held),
                    limits.joint_drift,
                    "of its range in 1 s, released at both ends and the middle");
    if (free == nullptr ||
        assets::LoadOn(*body.kinematics, joint, 0.0).mass < kTippingShare * whole)
      continue;
    results->AtMost("tips-" + engine + "-" + j.name,
                    sim::TiltWhenOpened(body, joint, free) * kDegrees, limits.tilt,
                    "degrees that the asset tilts while it opens");
  }
}

}  // namespace

void AddClearanceResults(const assets::UrdfModel& model, bool fixed, CheckResults* results) {
  results->Report("excluded-pairs", static_cast<double>(model.excluded_pairs.size()),
                  "pairs of links without contact, in all formats");
  for (size_t joint = 0; joint < model.joints.size(); ++joint) {
    if (CanBeTried(model.joints[joint])) {
      AddClearanceRow(model, static_cast<int>(joint), fixed, results);
    }
  }
}

void AddJointResultsInBullet(const assets::UrdfModel& model, bool fixed, const CheckLimits& limits,
                             CheckResults* results) {
  const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
  const auto held = sim::BulletRig(body);
  const auto free = fixed ? nullptr : sim::BulletRig(body, {.hold_root = false});
  AddEngineRows(body, "bullet", limits, held.get(), free.get(), results);
}

void AddJointResultsInMujoco(const assets::UrdfModel& model, const std::filesystem::path& mjcf,
                             bool fixed, const CheckLimits& limits, CheckResults* results) {
  const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
  const auto held = sim::MujocoRig(body, mjcf);
  const auto free = fixed ? nullptr : sim::MujocoRig(body, mjcf, {.hold_root = false});
  AddEngineRows(body, "mujoco", limits, held.get(), free.get(), results);
  for (const std::string& warning : held->Warnings()) {
    results->Fail("mujoco-warnings", warning);
    break;
  }
}

void AddJointResultsOfUrdf(const assets::UrdfModel& model, CheckResults* results) {
  const bool moves = std::any_of(model.joints.begin(), model.joints.end(), CanBeTried);
  if (!moves) return;
  for (size_t i = 0; i < model.joints.size(); ++i) {
    if (!model.joints[i].Moves() || model.links[i + 1].inertial) continue;
    results->Report("joints", 0.0,
                    "not tested: link '" + model.links[i + 1].name + "' has no inertial");
    return;
  }
  const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
  const auto rig = sim::BulletRig(body, {.hold_root = true, .self_contacts = false});
  const CheckLimits limits;
  for (const int joint : body.kinematics->moving_joints()) {
    const assets::Joint& j = body.joints()[static_cast<size_t>(joint)];
    if (!CanBeTried(j)) continue;
    AddSwingRow(body, joint, "bullet", false, limits, rig.get(), results);
    results->Report("holds-bullet-" + j.name, GreatestDrift(body, joint, rig.get()),
                    "of its range in 1 s, released at both ends and in the middle");
    const Clearance least = SweptClearance(model, joint);
    if (std::isfinite(least.distance)) {
      results->Report("clearance-" + j.name, least.distance * 1e3, "mm between " + least.pair);
    }
  }
}

}  // namespace simwright::validation
