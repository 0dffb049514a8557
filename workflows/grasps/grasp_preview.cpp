#include "workflows/grasps/grasp_preview.h"

#include <algorithm>
#include <string>
#include <utility>

#include "assets/articulated_asset.h"
#include "assets/primitive_meshes.h"
#include "render/turntable.h"

namespace simwright::workflows {
namespace {

using Eigen::Vector3d;

constexpr double kFingerLength = 0.045, kStem = 0.03, kRadius = 0.0012;  // m

// Appends a bar from `a` to `b`.
void AddBar(const Vector3d& a, const Vector3d& b, core::TriangleMesh* mesh) {
  core::TriangleMesh bar = assets::CylinderMesh(kRadius, (b - a).norm());
  Eigen::Isometry3d pose(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), b - a));
  pose.translation() = 0.5 * (a + b);
  core::Transform(Eigen::Affine3d(pose), &bar);
  core::Append(bar, mesh);
}

core::TexturedMesh WireGripper(const manipulation::Grasp& grasp) {
  const double half = 0.5 * grasp.opening;
  core::TexturedMesh gripper;
  AddBar({0, -half, 0}, {0, -half, -kFingerLength}, &gripper.mesh);
  AddBar({0, half, 0}, {0, half, -kFingerLength}, &gripper.mesh);
  AddBar({0, -half, -kFingerLength}, {0, half, -kFingerLength}, &gripper.mesh);
  AddBar({0, 0, -kFingerLength}, {0, 0, -kFingerLength - kStem}, &gripper.mesh);
  core::Transform(Eigen::Affine3d(grasp.object_from_tool), &gripper.mesh);
  core::Material material;
  material.name = "gripper";
  const auto share = static_cast<float>(grasp.quality);
  material.base_color = Eigen::Vector4f(0.85f * (1.0f - share), 0.65f * share, 0.1f, 1.0f);
  gripper.materials = {material};
  gripper.triangle_material.assign(gripper.mesh.triangles.size(), 0);
  return gripper;
}

}  // namespace

core::Image GraspPreview(const assets::Asset& asset, const manipulation::GraspSet& set, int count) {
  core::TexturedMesh mesh = asset.visual;
  mesh.triangle_part.clear();
  mesh.part_names.clear();
  if (mesh.triangle_material.empty()) {
    mesh.materials = {core::Material()};
    mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  }
  for (const int index : manipulation::FarthestGrasps(set.grasps, count)) {
    assets::AppendVisual(WireGripper(set.grasps[static_cast<size_t>(index)]), &mesh);
  }
  return render::Preview(mesh);
}

}  // namespace simwright::workflows
