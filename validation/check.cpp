#include "validation/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>

#include "asset_build/rest_pose.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "geometry/concavity.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "geometry/surface_distance.h"
#include "sim/drop_test.h"
#include "sim/mujoco.h"
#include "sim/world.h"
#include "validation/check_articulated.h"
#include "validation/check_joints.h"
#include "validation/shared_results.h"

namespace simwright::validation {
namespace fs = std::filesystem;
namespace {

void CheckSolid(const assets::Asset& asset, const CheckLimits& limits, CheckResults* results) {
  const geometry::MeshValidity s = geometry::Examine(asset.solid);
  results->Require("closed", s.closed, s.open_edges + s.non_manifold_edges,
                   "edges without two faces");
  results->Require("oriented", s.oriented && s.signed_volume > 0.0, s.signed_volume,
                   "volume in m3, faces all outward");
  results->Require("self-intersections", s.self_intersections == 0, s.self_intersections,
                   "crossing pairs of faces");
  const geometry::SurfaceDistance distance =
      geometry::OuterSurfaceDistance(asset.visual.mesh, asset.solid);
  results->AtMost("surface-distance", distance.MaxRatio(), limits.surface_distance_ratio,
                  "of the diagonal between solid and visual, farthest point");
}

void CheckParts(const assets::Asset& asset, const CheckLimits& limits, CheckResults* results) {
  results->Report("parts", static_cast<double>(asset.parts.size()), "convex collision parts");
  results->Report("concavity", asset.concavity, "of the parts, in CoACD's units (longest side 2)");
  geometry::ConcavityOptions options;
  options.surface_samples = 6000;
  options.volume_samples = 1000;
  const geometry::DecompositionQuality quality =
      geometry::MeasureDecomposition(asset.solid, asset.parts, options);
  results->Report("parts-hausdorff", quality.concavity,
                  "of the diagonal between the solid's surface and the parts', farthest point");
  results->AtMost("parts-cover", quality.uncovered, limits.cover_distance_ratio,
                  "of the diagonal from the solid's surface to the nearest part, farthest point");
  int bad = 0;
  for (const core::TriangleMesh& part : asset.parts) {
    const geometry::MeshValidity s = geometry::Examine(part);
    bad += !s.closed || s.signed_volume <= 0.0 || part.vertices.size() > 64;
  }
  results->Require("parts-closed", bad == 0, bad, "parts open or above 64 vertices");
}

geometry::MassProperties ExactMassProperties(const assets::Asset& asset) {
  if (asset.wall_thickness == 0.0) {
    return geometry::SolidMassProperties(asset.solid, asset.density);
  }
  return asset.wall_on_surface
             ? geometry::ShellMassProperties(asset.solid, asset.wall_thickness, asset.density)
             : geometry::HollowMassProperties(asset.solid, asset.wall_thickness, asset.density);
}

void CheckInertia(const assets::Asset& asset, const CheckLimits& limits, CheckResults* results) {
  const geometry::MassProperties exact = ExactMassProperties(asset);
  const double size = core::Bounds(asset.solid).diagonal().norm();
  results->AtMost(
      "inertia-exact",
      InertialDifference(asset.inertial, {exact.mass, exact.center_of_mass, exact.inertia}, size),
      limits.reader_tolerance, "from the integrals over solid.obj, relative");
  const Eigen::Vector3d moments = geometry::PrincipalInertiaOf(asset.inertial.inertia).moments;
  results->Require("inertia-possible", geometry::SatisfiesTriangleInequality(moments),
                   moments[2] / (moments[0] + moments[1]),
                   "largest principal moment over the sum of the other two");
}

void CheckReaders(const assets::Asset& asset, const fs::path& folder, const CheckLimits& limits,
                  CheckResults* results) {
  const double size = core::Bounds(asset.solid).diagonal().norm();
  const auto compare = [&](const std::string& code, const assets::Inertial& inertial,
                           const std::string& warning) {
    if (!warning.empty()) {
      results->Fail(code, warning);
      return;
    }
    results->AtMost(code, InertialDifference(inertial, asset.inertial, size),
                    limits.reader_tolerance,
                    "mass, centre and inertia against asset.json, relative");
  };
  std::optional<assets::UrdfModel> read;
  AddResultOrFailure("loads-urdfdom", results, [&] {
    read = assets::ReadUrdf(folder / (asset.name + ".urdf"));
    const assets::UrdfModel& model = *read;
    const std::string warning = model.findings.empty() ? "" : model.findings[0].sentence;
    if (!model.links[0].inertial) throw core::Error("the URDF has no inertial");
    compare("loads-urdfdom", *model.links[0].inertial, warning);
  });
  AddResultOrFailure("loads-bullet", results, [&] {
    if (!read) throw core::Error("the URDF cannot be read");
    sim::World world;
    const sim::RigidBody body = sim::BodyFromUrdf(*read);
    world.Add(body, Eigen::Isometry3d::Identity());
    compare("loads-bullet", world.LoadedInertial(0), "");
  });
  AddResultOrFailure("loads-mujoco", results, [&] {
    const sim::MujocoWorld world(folder / (asset.name + ".xml"));
    compare("loads-mujoco", world.LoadedInertial(0),
            world.warnings().empty() ? "" : world.warnings()[0]);
  });
}

void CheckDynamics(const assets::Asset& asset, const fs::path& folder, const CheckLimits& limits,
                   CheckResults* results) {
  const sim::RigidBody body = sim::BodyFromAsset(asset);
  sim::DropOptions options;
  const double size = core::Bounds(asset.solid).diagonal().norm();
  // Regardless of asset.json, a body that stands or falls is not graded as a rolling one.
  const bool rolls = asset.rolls && asset_build::RollsInPose(body, asset.solid);
  const auto add = [&](const sim::DropResult& drop, const std::string& engine) {
    if (asset.rolls && !rolls) {
      AddRockingResults(drop, engine, size, limits, results);
    } else {
      AddRestResults(drop, engine, rolls, size, limits, results);
    }
  };
  const sim::DropResult bullet = sim::DropInBullet(body, options);
  add(bullet, "bullet");
  AddResultOrFailure("settles-mujoco", results, [&] {
    std::vector<std::string> warnings;
    const sim::DropResult mujoco =
        sim::DropInMujoco(body, folder / (asset.name + ".xml"), options, &warnings);
    add(mujoco, "mujoco");
    if (!warnings.empty()) results->Fail("mujoco-warnings", warnings[0]);
    if (asset.rolls) return;
    const Eigen::Vector3d com = asset.inertial.center_of_mass;
    results->AtMost(
        "engines-agree", std::abs((bullet.rest_pose * com - mujoco.rest_pose * com).z()) * 1e3,
        InUnit(limits.engines_distance, 1e3), "mm in height between Bullet and MuJoCo at rest");
    results->AtMost("engines-agree-tilt",
                    sim::TiltBetween(bullet.rest_pose, mujoco.rest_pose) * kDegrees,
                    limits.engines_tilt, "degrees between Bullet and MuJoCo at rest, yaw free");
  });
}

}  // namespace

CheckReport CheckAsset(const fs::path& folder, const CheckLimits& limits) {
  if (assets::IsArticulatedAssetFolder(folder)) return CheckArticulatedAsset(folder, limits);
  const assets::Asset asset = assets::ReadAsset(folder);
  CheckResults results(folder.filename().string());
  CheckSolid(asset, limits, &results);
  CheckParts(asset, limits, &results);
  CheckInertia(asset, limits, &results);
  CheckReaders(asset, folder, limits, &results);
  AddResultOrFailure("settles-bullet", &results,
                     [&] { CheckDynamics(asset, folder, limits, &results); });
  CheckReport report{folder.string(), {}};
  AddResultOrFailure("appearance", &results, [&] {
    if (const auto photo = ReadAssetPhoto(folder))
      report.appearance = JudgeAppearance(asset, *photo);
  });
  report.results = results.Take();
  return report;
}

CheckReport CheckBeforeKeeping(const fs::path& folder, const std::string& name,
                               const CheckLimits& limits) {
  CheckReport report = CheckAsset(folder, limits);
  for (core::Finding& row : report.results) row.place = name;  // the folder's name may be temporary
  RequirePassed(report, name);
  assets::AddFindings(folder, report.Warnings());
  return report;
}

namespace {

// Returns true for a root link that represents the world: it has neither shapes nor mass, and it is
// named "world", as in ROS, or a moving joint hangs on it.
bool RootIsWorld(const assets::UrdfModel& model) {
  const assets::UrdfLink& root = model.links[0];
  if (root.inertial || !root.visuals.empty() || !root.collisions.empty()) return false;
  return root.name == "world" ||
         std::any_of(model.joints.begin(), model.joints.end(), [&](const assets::Joint& joint) {
           return joint.parent == root.name && joint.Moves();
         });
}

void AddShapeResults(const assets::UrdfModel& model, const CheckLimits& limits,
                     CheckResults* results) {
  int shapes = 0, open = 0, bodies = 0;
  for (const assets::UrdfLink& link : model.links) {
    bodies += link.inertial.has_value();
    for (const assets::UrdfShape& shape : link.collisions) {
      ++shapes;
      open += !geometry::Examine(shape.mesh).closed;
    }
  }
  results->Require("collision-shapes", shapes > 0, shapes, "collision shapes");
  results->Require("collision-closed", open == 0, open, "open collision shapes");
  results->Require("inertials", bodies > 0, bodies, "links with mass and a possible inertia");
  if (shapes == 0 || bodies == 0) return;
  if (RootIsWorld(model)) {
    results->Report("settles-bullet", 0.0,
                    "not tested: the root '" + model.links[0].name + "' is fixed to the world");
    return;
  }
  const sim::RigidBody body = sim::BodyFromUrdf(model);
  AddRestResults(sim::DropInBullet(body, sim::DropOptions()), "bullet", false,
                 2.0 * sim::Radius(body), limits, results);
}

}  // namespace

CheckReport CheckUrdf(const fs::path& urdf, const fs::path& root, const CheckLimits& limits) {
  CheckResults results(urdf.filename().string());
  assets::UrdfModel model;
  bool read = false;
  AddResultOrFailure("loads-urdfdom", &results, [&] {
    model = assets::ReadUrdf(urdf, {root, true});
    read = true;
  });
  if (!read) return {urdf.string(), results.Take()};
  results.Report("links", static_cast<double>(model.links.size()), "links");
  for (core::Finding finding : model.findings) {
    // A strict reader rejects the file for this.
    if (finding.code == "urdf-impossible-inertial") finding.severity = core::Severity::kError;
    results.Warn(finding);
  }
  AddShapeResults(model, limits, &results);
  AddResultOrFailure("joints", &results, [&] { AddJointResultsOfUrdf(model, &results); });
  return {urdf.string(), results.Take()};
}

}  // namespace simwright::validation
