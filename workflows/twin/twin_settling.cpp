#include "workflows/twin/twin_settling.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/primitive_meshes.h"
#include "assets/semantic_model.h"
#include "assets/urdf_reader.h"
#include "core/parallel.h"
#include "scene/feasibility/feasible_scene.h"
#include "sim/rigid_body.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr char kTable[] = "twin_table";
constexpr double kTableSide = 8.0, kTableThickness = 0.2;  // m
constexpr double kTableDensity = 700.0;                    // kg/m3
constexpr double kLargestMove = 0.05;  // m: an object that physics moves farther is reported
constexpr double kClearance = 5e-4;    // m: objects start this high above the table

sim::RigidBody TableBody() {
  sim::RigidBody body;
  body.name = kTable;
  core::TriangleMesh board =
      assets::BoxMesh(Eigen::Vector3d(kTableSide, kTableSide, kTableThickness));
  Eigen::Affine3d below = Eigen::Affine3d::Identity();
  below.translation().z() = -0.5 * kTableThickness;
  core::Transform(below, &board);
  body.parts.push_back(std::move(board));
  body.inertial.mass = kTableDensity * kTableSide * kTableSide * kTableThickness;
  body.inertial.inertia =
      body.inertial.mass * kTableSide * kTableSide * Eigen::Matrix3d::Identity();
  return body;
}

sim::RigidBody BodyOf(const fs::path& asset, bool articulated) {
  if (articulated) return sim::BodyFromUrdf(assets::ReadUrdf(assets::UrdfIn(asset)));
  return sim::BodyFromAsset(assets::ReadAsset(asset));
}

// Lifts an object out of the table.
void RaiseAboveTable(const sim::RigidBody& body, Eigen::Isometry3d* world_from_object) {
  const double lowest = sim::LowestPoint(body, *world_from_object);
  world_from_object->translation().z() += kClearance - lowest;
}

}  // namespace

void SettleTwin(const fs::path& assets, TwinRecord* record, core::Findings* findings) {
  scene::AssetSet asset_set;
  std::vector<scene::SceneObject> objects;
  asset_set.Add(kTable, TableBody());
  objects.push_back({kTable, kTable, Eigen::Isometry3d::Identity(), true, -1});
  for (TwinObject& object : record->objects) {
    const sim::RigidBody body = BodyOf(assets / object.name, object.articulated);
    RaiseAboveTable(body, &object.world_from_object);
    asset_set.Add(object.name, body);
    objects.push_back({object.name, object.name, object.world_from_object, object.articulated, 0});
  }
  scene::FeasibilityOptions options;
  options.settling = sim::SettlingOptions();
  options.min_objects = 0;
  for (const TwinObject& object : record->objects) options.may_lie.insert(object.name);
  const scene::FeasibleScene settled = scene::MakeFeasible(objects, asset_set, options);
  record->penetration = settled.penetration;
  record->stands = settled.valid && settled.dropped == 0;
  std::set<int> kept;
  for (size_t k = 0; k < settled.objects.size(); ++k) {
    const int index = settled.indices[k] - 1;
    if (index < 0) continue;
    kept.insert(index);
    TwinObject& object = record->objects[static_cast<size_t>(index)];
    object.settled = (settled.objects[k].world_from_object.translation() -
                      object.world_from_object.translation())
                         .norm();
    object.world_from_object = settled.objects[k].world_from_object;
    if (object.settled > kLargestMove) {
      findings->push_back({"twin-moved", core::Severity::kWarning, object.name,
                           "physics moves the object far from where the photo shows it",
                           object.settled, "compare twin.png with the photo"});
    }
  }
  for (size_t i = 0; i < record->objects.size(); ++i) {
    if (kept.contains(static_cast<int>(i))) continue;
    findings->push_back({"twin-does-not-stand", core::Severity::kWarning, record->objects[i].name,
                         "the object falls or topples where the photo shows it; it keeps that pose",
                         0.0, "give its box and category with --objects, or leave it out"});
  }
}

}  // namespace simwright::workflows
