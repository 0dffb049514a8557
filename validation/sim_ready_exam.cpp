#include "validation/sim_ready_exam.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "asset_build/rest_pose.h"
#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/stable_poses.h"
#include "sim/body_experiments.h"
#include "validation/shared_results.h"

namespace simwright::validation {
namespace fs = std::filesystem;
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGravity = 9.81;          // m/s^2
constexpr double kDropHeight = 0.1;        // m
constexpr double kDropSeconds = 3.0;       // until rest
constexpr double kHoldShare = 0.8;         // of the friction angle: the body stays
constexpr double kSlideShare = 1.3;        // of the friction angle: the body slides
constexpr double kTippingShare = 0.7;      // of the tipping angle: the body does not tip
constexpr double kLeastSlope = 1.0;        // degrees: a smaller slope tells nothing
constexpr double kCrateHeight = 0.1;       // m
constexpr double kPlateThickness = 0.005;  // m
constexpr double kTopSlack = 5e-4;         // m: points of the top this far below the highest
constexpr double kMostSettling = 5e-3;     // m
constexpr double kStackWatch = 2.0;        // s

// An asset and what the exam knows about it before it is simulated.
struct Examinee {
  const assets::Asset& asset;
  sim::RigidBody body;
  bool rolls = false;
  double tipping_angle = 0.0;   // rad, the smallest of all directions
  double friction_angle = 0.0;  // rad
};

Examinee Prepare(const assets::Asset& asset) {
  Examinee examinee{asset, sim::BodyFromAsset(asset)};
  const sim::RigidBody& body = examinee.body;
  std::vector<Vector3d> points;
  for (const core::TriangleMesh& part : body.parts) {
    points.insert(points.end(), part.vertices.begin(), part.vertices.end());
  }
  examinee.rolls = asset.rolls || asset_build::RollsInPose(body, asset.solid);
  examinee.tipping_angle = geometry::TippingAngle(
      geometry::ConvexHull(points), body.inertial.center_of_mass, -Vector3d::UnitZ(), kTopSlack);
  examinee.friction_angle = std::atan(body.friction);
  return examinee;
}

// Returns the pose on the floor, in the rest pose.
Isometry3d OnFloor(const sim::RigidBody& body, double floor) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation().z() = floor - sim::LowestPoint(body, Isometry3d::Identity());
  return pose;
}

void AddDropRow(const Examinee& examinee, const std::string& engine, const CheckLimits& limits,
                const sim::BodyRigFactory& rigs, CheckResults* results) {
  sim::DropOptions options;
  options.height = kDropHeight;
  options.settle_time = kDropSeconds;
  const sim::DropResult drop = sim::DropBody(examinee.body, options, rigs);
  const std::string code = "drop-far-" + engine;
  if (!drop.final_pose.matrix().allFinite()) {
    results->Fail(code, "its pose is not finite after a drop from 10 cm");
    return;
  }
  if (-drop.lowest_point > limits.sinking.worst) {
    results->Require(code, false, -drop.lowest_point * 1e3, "mm below the floor after 10 cm");
    return;
  }
  // A body that rolls away must not gain speed. Rocking is not rolling: it decays.
  const bool rolls_on = drop.late_drift <= drop.early_drift + limits.drift.good;
  results->Require(code, drop.rests || rolls_on, drop.rest_time,
                   drop.rests ? "s until it is at rest after a drop from 10 cm"
                              : "s, and it still moves after a drop from 10 cm" +
                                    std::string(rolls_on ? ", slowing down" : ""));
}

void AddSlopeRow(const Examinee& examinee, const std::string& engine, const CheckLimits& limits,
                 const sim::BodyRigFactory& rigs, CheckResults* results) {
  const std::string code = "slope-" + engine;
  sim::SlopeOptions options;
  options.angle =
      std::min(kHoldShare * examinee.friction_angle, kTippingShare * examinee.tipping_angle);
  const double degrees = options.angle * kDegrees;
  if (examinee.rolls || degrees < kLeastSlope) {
    results->Report(code, degrees,
                    examinee.rolls ? "degrees; not examined: it rolls"
                                   : "degrees; not examined: it tips at once");
    return;
  }
  double farthest = 0.0;
  for (const double direction : {0.0, 0.5, 1.0, 1.5}) {
    options.direction = direction * std::numbers::pi;
    farthest = std::max(
        farthest,
        sim::StandOnSlope(examinee.body, OnFloor(examinee.body, 0.0), options, rigs).displacement);
  }
  char what[96];
  std::snprintf(what, sizeof(what), "mm in 0.6 s on a slope of %.1f degrees", degrees);
  results->AtMost(code, farthest * 1e3, InUnit(limits.drift, 1e3), what);
}

void AddSlideRow(const Examinee& examinee, const std::string& engine,
                 const sim::BodyRigFactory& rigs, CheckResults* results) {
  const std::string code = "slides-" + engine;
  sim::SlopeOptions options;
  options.angle = kSlideShare * examinee.friction_angle;
  if (examinee.rolls || options.angle > kTippingShare * examinee.tipping_angle) {
    results->Report(code, options.angle * kDegrees,
                    examinee.rolls ? "degrees; not examined: it rolls"
                                   : "degrees; not examined: it would tip before it slides");
    return;
  }
  options.watch = 0.4;
  const sim::SlopeResult slide =
      sim::StandOnSlope(examinee.body, OnFloor(examinee.body, 0.0), options, rigs);
  const double exact =
      kGravity * (std::sin(options.angle) - examinee.body.friction * std::cos(options.angle));
  char what[128];
  std::snprintf(what, sizeof(what),
                "of the acceleration of Coulomb's law on a slope of %.1f degrees, difference",
                options.angle * kDegrees);
  results->AtMost(code, std::abs(slide.acceleration / exact - 1.0), GradedLimit{0.1, 0.25}, what);
}

// Returns the plate that lies on the top, if the polygon of the highest points bears one: its
// centroid is well inside the support polygon, and it is at least a tenth as wide as the body.
std::optional<sim::RigBox> PlateOn(const Examinee& examinee, double floor) {
  const sim::RigidBody& body = examinee.body;
  std::vector<Vector2d> top;
  double highest = -HUGE_VAL;
  Eigen::AlignedBox3d bounds;
  for (const core::TriangleMesh& part : body.parts) bounds.extend(core::Bounds(part));
  highest = bounds.max().z();
  for (const core::TriangleMesh& part : body.parts) {
    for (const Vector3d& point : part.vertices) {
      if (point.z() > highest - kTopSlack) top.push_back(point.head<2>());
    }
  }
  const std::vector<Vector2d> polygon = geometry::ConvexHull2d(top);
  if (polygon.size() < 3) return std::nullopt;
  Eigen::AlignedBox2d extent;
  for (const Vector2d& point : polygon) extent.extend(point);
  const Vector2d center = extent.center();
  const double least = 0.1 * bounds.sizes().head<2>().maxCoeff();
  // Distance from the plate's centre to the polygon's edges, and how far it is off the body's
  // centre of mass, which the support polygon must bear.
  double inside = HUGE_VAL;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d a = polygon[i], edge = polygon[(i + 1) % polygon.size()] - a;
    inside = std::min(inside, (edge.x() * (center - a).y() - edge.y() * (center - a).x()) /
                                  std::max(edge.norm(), 1e-12));
  }
  const double offset = (center - body.inertial.center_of_mass.head<2>()).norm();
  const double margin = std::tan(examinee.tipping_angle) * body.inertial.center_of_mass.z();
  if (inside < 0.5 * least || offset > 0.8 * margin) return std::nullopt;
  sim::RigBox plate;
  plate.size = Vector3d(extent.sizes().x(), extent.sizes().y(), kPlateThickness);
  plate.mass = 0.5 * body.inertial.mass;
  plate.world_from_box.translation() =
      Vector3d(center.x(), center.y(),
               OnFloor(body, floor).translation().z() + highest + 0.5 * kPlateThickness);
  return plate;
}

void AddStackRow(const Examinee& examinee, const std::string& engine, const CheckLimits& limits,
                 const sim::BodyRigFactory& rigs, CheckResults* results) {
  const std::string code = "stack-" + engine;
  if (examinee.rolls || examinee.tipping_angle * kDegrees < kLeastSlope) {
    results->Report(
        code, 0.0,
        examinee.rolls ? "not examined: it rolls" : "not examined: no pose of it is stable");
    return;
  }
  Eigen::AlignedBox3d bounds;
  for (const core::TriangleMesh& part : examinee.body.parts) bounds.extend(core::Bounds(part));
  sim::RigBox crate;
  crate.size = Vector3d(1.2 * bounds.sizes().x(), 1.2 * bounds.sizes().y(), kCrateHeight);
  crate.mass = std::max(0.5, 2.0 * examinee.body.inertial.mass);
  crate.world_from_box.translation() =
      Vector3d(bounds.center().x(), bounds.center().y(), 0.5 * kCrateHeight);
  std::vector<sim::RigBox> boxes = {crate};
  const auto plate = PlateOn(examinee, kCrateHeight);
  if (plate) boxes.push_back(*plate);
  const sim::StackResult stack = sim::StandInStack(
      examinee.body, OnFloor(examinee.body, kCrateHeight), boxes, kStackWatch, rigs);
  if (stack.penetration > limits.sinking.worst) {
    results->Require(code, false, stack.penetration * 1e3, "mm of penetration on a crate");
    return;
  }
  if (stack.settling > kMostSettling) {
    results->Require(code, false, stack.settling * 1e3, "mm of displacement as a stack settles");
    return;
  }
  results->AtMost(
      code, *std::max_element(stack.displacements.begin(), stack.displacements.end()) * 1e3,
      InUnit(limits.drift, 1e3),
      std::string("mm in 2 s on a crate") + (plate ? ", under a plate of half its mass" : ""));
}

}  // namespace

void AddSimReadyExam(const assets::Asset& asset, const fs::path& folder, const CheckLimits& limits,
                     CheckResults* results) {
  const Examinee examinee = Prepare(asset);
  const fs::path mjcf = folder / (asset.name + ".xml");
  const std::pair<const char*, sim::BodyRigFactory> engines[] = {
      {"bullet",
       [&](const Isometry3d& pose, const std::vector<sim::RigBox>& boxes) {
         return sim::BulletBodyRig(examinee.body, pose, boxes);
       }},
      {"mujoco", [&](const Isometry3d& pose, const std::vector<sim::RigBox>& boxes) {
         return sim::MujocoBodyRig(mjcf, examinee.body, pose, boxes);
       }}};
  for (const auto& [engine, rigs] : engines) {
    AddResultOrFailure(std::string("exam-") + engine, results, [&, name = engine, &make = rigs] {
      AddDropRow(examinee, name, limits, make, results);
      AddSlopeRow(examinee, name, limits, make, results);
      AddSlideRow(examinee, name, make, results);
      AddStackRow(examinee, name, limits, make, results);
    });
  }
}

}  // namespace simwright::validation
