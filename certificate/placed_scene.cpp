#include "certificate/placed_scene.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"

namespace simwright::certificate {

BodyModel::BodyModel(const sim::RigidBody& body, std::vector<manipulation::Grasp> proved)
    : meshes(body.parts),
      center_of_mass(body.inertial.center_of_mass),
      friction(body.friction),
      radius(sim::Radius(body)),
      physics(std::make_shared<sim::PreparedBody>(sim::ArticulatedBodyFrom(body))),
      grasps(std::move(proved)) {
  if (body.parts.empty()) throw core::Error("a body has no collision parts", body.name);
  for (const core::TriangleMesh& mesh : meshes) {
    parts.push_back({mesh.vertices, 0.0});
    for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  }
}

PlacedScene PlacedScene::Without(const std::vector<int>& removed) const {
  PlacedScene scene;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (std::find(removed.begin(), removed.end(), static_cast<int>(i)) != removed.end()) continue;
    scene.bodies.push_back(bodies[i]);
  }
  return scene;
}

int PlacedScene::Find(const std::string& name) const {
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

Eigen::AlignedBox3d BoundsOf(const BodyModel& model, const Eigen::Isometry3d& world_from_body) {
  Eigen::AlignedBox3d box;
  for (const geometry::ConvexShape& part : model.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) box.extend(world_from_body * vertex);
  }
  return box;
}

Eigen::AlignedBox3d BoundsOf(const PlacedBody& body) {
  return BoundsOf(*body.model, body.world_from_body);
}

int SupportOf(const PlacedScene& scene, int body) {
  const Eigen::AlignedBox3d box = BoundsOf(scene.bodies[static_cast<size_t>(body)]);
  const Eigen::Vector3d middle = box.center();
  int support = -1;
  double highest = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const PlacedBody& other = scene.bodies[i];
    if (!other.fixed || static_cast<int>(i) == body) continue;
    for (const geometry::ConvexShape& part : other.model->parts) {
      Eigen::AlignedBox3d part_box;
      for (const Eigen::Vector3d& vertex : part.vertices) {
        part_box.extend(other.world_from_body * vertex);
      }
      const double top = part_box.max().z();
      if (top > middle.z() || top <= highest) continue;
      if (middle.x() < part_box.min().x() || middle.x() > part_box.max().x()) continue;
      if (middle.y() < part_box.min().y() || middle.y() > part_box.max().y()) continue;
      highest = top;
      support = static_cast<int>(i);
    }
  }
  return support;
}

}  // namespace simwright::certificate
