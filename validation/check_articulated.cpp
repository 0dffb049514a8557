#include "validation/check_articulated.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/joint_poses.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "physics_params/knowledge_base.h"
#include "sim/joint_experiments.h"
#include "validation/check_joints.h"
#include "validation/check_results.h"
#include "validation/grasp_search.h"
#include "validation/shared_results.h"

namespace simwright::validation {
namespace fs = std::filesystem;
namespace {

using assets::ArticulatedAsset;
using assets::ArticulatedLink;

constexpr size_t kMostVertices = 64;

void CheckLinkParts(const ArticulatedAsset& asset, CheckResults* results) {
  int parts = 0, bad = 0;
  for (const ArticulatedLink& link : asset.links) {
    for (const core::TriangleMesh& part : link.parts) {
      ++parts;
      const geometry::MeshValidity s = geometry::Examine(part);
      bad += !s.closed || !(s.signed_volume > 0.0) || part.vertices.size() > kMostVertices;
    }
  }
  results->Report("links", static_cast<double>(asset.links.size()), "links");
  results->Require("parts-closed", parts > 0 && bad == 0, bad, "parts open or above 64 vertices");
}

double SizeOf(const ArticulatedLink& link) {
  Eigen::AlignedBox3d box;
  for (const core::TriangleMesh& part : link.parts) box.extend(core::Bounds(part));
  return box.diagonal().norm();
}

void CheckInertials(const ArticulatedAsset& asset, const CheckLimits& limits,
                    CheckResults* results) {
  double exact = 0.0, flattest = 0.0, mass = 0.0;
  bool possible = true;
  for (const ArticulatedLink& link : asset.links) {
    geometry::MassProperties total;
    for (size_t i = 0; i < link.parts.size(); ++i) {
      const auto one = geometry::SolidMassProperties(link.parts[i], link.densities[i]);
      total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
    }
    exact = std::max(
        exact, InertialDifference(link.inertial, {total.mass, total.center_of_mass, total.inertia},
                                  SizeOf(link)));
    const Eigen::Vector3d m = geometry::PrincipalInertiaOf(link.inertial.inertia).moments;
    possible = possible && geometry::SatisfiesTriangleInequality(m);
    flattest = std::max(flattest, m[2] / (m[0] + m[1]));
    mass += link.inertial.mass;
  }
  results->AtMost("inertia-exact", exact, limits.reader_tolerance,
                  "from the integrals over the parts, relative, the worst link");
  results->Require("inertia-possible", possible, flattest,
                   "largest principal moment over the sum of the other two, the worst link");
  const physics_params::Category* row =
      physics_params::KnowledgeBase::Shipped().FindCategory(asset.parameters.category);
  const double low = row ? row->mass.min : asset.parameters.mass.min;
  const double high = row ? row->mass.max : asset.parameters.mass.max;
  results->Require("mass-plausible", mass >= 0.5 * low && mass <= 2.0 * high, mass,
                   "kg, within a factor of 2 of its kind's range");
}

// Compares a reader's inertials with asset.json's, link by link.
template <typename InertialOf>
void CompareLinks(const ArticulatedAsset& asset, const std::string& code, const CheckLimits& limits,
                  CheckResults* results, const InertialOf& inertial_of) {
  double worst = 0.0;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    worst = std::max(
        worst, InertialDifference(inertial_of(i), asset.links[i].inertial, SizeOf(asset.links[i])));
  }
  results->AtMost(code, worst, limits.reader_tolerance,
                  "mass, centre and inertia of every link against asset.json, relative");
}

void CheckArticulatedReaders(const ArticulatedAsset& asset, const assets::UrdfModel& model,
                             bool urdf_read, const fs::path& mjcf, const CheckLimits& limits,
                             CheckResults* results) {
  AddResultOrFailure("loads-urdfdom", results, [&] {
    if (!urdf_read) return;  // its own result gives the reason
    if (!model.findings.empty()) throw core::Error(model.findings[0].sentence);
    std::map<std::string, assets::Inertial> by_name;
    for (const assets::UrdfLink& link : model.links) {
      if (link.inertial) by_name[link.name] = *link.inertial;
    }
    CompareLinks(asset, "loads-urdfdom", limits, results, [&](size_t i) {
      const auto found = by_name.find(asset.links[i].name);
      if (found == by_name.end()) {
        throw core::Error("the URDF has no inertial for '" + asset.links[i].name + "'");
      }
      return found->second;
    });
  });
  const auto compare = [&](const std::string& code, const sim::ArticulatedBody& body,
                           const sim::JointRig& rig) {
    CompareLinks(asset, code, limits, results, [&](size_t i) {
      return rig.LoadedInertial(body.kinematics->LinkIndex(asset.links[i].name));
    });
  };
  AddResultOrFailure("loads-bullet", results, [&] {
    const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
    compare("loads-bullet", body, *sim::BulletRig(body));
  });
  AddResultOrFailure("loads-mujoco", results, [&] {
    const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(model);
    const auto rig = sim::MujocoRig(body, mjcf);
    if (!rig->Warnings().empty()) throw core::Error(rig->Warnings()[0]);
    compare("loads-mujoco", body, *rig);
  });
}

void CheckSemantics(const ArticulatedAsset& asset, const fs::path& folder, CheckResults* results) {
  AddResultOrFailure("semantics", results, [&] {
    const assets::SemanticModel model = assets::ReadSemanticModel(folder / (asset.name + ".urdf"));
    int wrong = static_cast<int>(model.model.findings.size());
    for (const ArticulatedLink& link : asset.links) {
      const auto found = model.semantics.find(link.name);
      wrong += found == model.semantics.end() || found->second.label != link.label;
    }
    results->Require("semantics", wrong == 0, wrong, "wrong links or lines of semantics.txt");
  });
}

void CheckGrasps(const ArticulatedAsset& asset, const assets::UrdfModel& model,
                 CheckResults* results) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  std::map<std::string, std::vector<core::TriangleMesh>> parts;
  for (size_t i = 0; i < model.links.size(); ++i) {
    for (const assets::UrdfShape& shape : model.links[i].collisions) {
      core::TriangleMesh part = shape.mesh;
      core::Transform(Eigen::Affine3d(poses[i]), &part);
      parts[model.links[i].name].push_back(std::move(part));
    }
  }
  for (const ArticulatedLink& link : asset.links) {
    if (link.label != "handle" && link.label != "lever") continue;
    std::vector<core::TriangleMesh> others;
    for (const auto& [name, meshes] : parts) {
      if (name != link.name) others.insert(others.end(), meshes.begin(), meshes.end());
    }
    const GraspSearch search = SearchGrasps(parts[link.name], others);
    results->Require("grasp-" + link.name, search.found > 0, search.found,
                     "of " + std::to_string(search.tried) +
                         " directions from which a gripper of 8 cm can grasp, at least 1");
  }
}

void CheckRest(const assets::UrdfModel& model, sim::JointRig* rig, const std::string& engine,
               const CheckLimits& limits, CheckResults* results) {
  const sim::RigidBody whole = sim::BodyFromUrdf(model);
  const sim::DropOptions options;
  const double size = 2.0 * sim::Radius(whole);
  AddRestResults(sim::DropRig(whole, options, rig), engine, false, size, limits, results);
}

// Checks an asset's dynamics in Bullet and in MuJoCo. A robot is fixed and its joints are not
// tested: its links may collide, and without motors it collapses; planners and motors take care of
// both.
void CheckInBullet(const ArticulatedAsset& asset, const assets::UrdfModel& model,
                   const CheckLimits& limits, CheckResults* results) {
  if (!asset.fixed) {
    const auto rig = sim::BulletRig(sim::ArticulatedBodyFrom(model), {.hold_root = false});
    CheckRest(model, rig.get(), "bullet", limits, results);
  }
  if (!assets::IsRobot(asset)) AddJointResultsInBullet(model, asset.fixed, limits, results);
}

void CheckInMujoco(const ArticulatedAsset& asset, const assets::UrdfModel& model,
                   const fs::path& mjcf, const CheckLimits& limits, CheckResults* results) {
  if (!asset.fixed) {
    const auto rig = sim::MujocoRig(sim::ArticulatedBodyFrom(model), mjcf, {.hold_root = false});
    CheckRest(model, rig.get(), "mujoco", limits, results);
  }
  if (!assets::IsRobot(asset)) AddJointResultsInMujoco(model, mjcf, asset.fixed, limits, results);
}

}  // namespace

CheckReport CheckArticulatedAsset(const fs::path& folder, const CheckLimits& limits) {
  const ArticulatedAsset asset = assets::ReadArticulatedAsset(folder);
  CheckResults results(folder.filename().string());
  CheckLinkParts(asset, &results);
  CheckInertials(asset, limits, &results);
  // A file that one reader rejects does not prevent the checks with the others.
  assets::UrdfModel model = assets::ModelOf(asset);
  bool read = false;
  AddResultOrFailure("loads-urdfdom", &results, [&] {
    model = assets::ReadUrdf(folder / (asset.name + ".urdf"));
    read = true;
  });
  const fs::path mjcf = folder / (asset.name + ".xml");
  // The steps run in parallel, each with its own results; the order below is that of the report.
  const std::pair<const char*, std::function<void(CheckResults*)>> steps[] = {
      {"joints-bullet", [&](CheckResults* own) { CheckInBullet(asset, model, limits, own); }},
      {"joints-mujoco", [&](CheckResults* own) { CheckInMujoco(asset, model, mjcf, limits, own); }},
      {"files",
       [&](CheckResults* own) {
         CheckArticulatedReaders(asset, model, read, mjcf, limits, own);
         if (read) CheckSemantics(asset, folder, own);
       }},
      {"geometry", [&](CheckResults* own) {
         CheckGrasps(asset, model, own);
         if (!assets::IsRobot(asset)) AddClearanceResults(model, asset.fixed, own);
       }}};
  std::vector<CheckResults> parts(std::size(steps), CheckResults(folder.filename().string()));
  core::ParallelFor(static_cast<int>(parts.size()), [&](int i) {
    const auto& [code, step] = steps[i];
    CheckResults* own = &parts[static_cast<size_t>(i)];
    AddResultOrFailure(code, own, [&] { step(own); });
  });
  for (const size_t i : {2, 3, 0, 1}) {
    for (const core::Finding& row : parts[i].Take()) results.Warn(row);
  }
  return {folder.string(), results.Take()};
}

}  // namespace simwright::validation
