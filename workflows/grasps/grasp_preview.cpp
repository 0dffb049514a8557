#include "workflows/grasps/grasp_preview.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "assets/articulated_asset.h"
#include "assets/primitive_meshes.h"
#include "render/turntable.h"

namespace simwright::workflows {
namespace {

using Eigen::Vector3d;

constexpr int kAll = 24, kAtLink = 10;  // grasps of a rigid asset, and at a link
constexpr size_t kMostLinks = 6;
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

// Returns four views of `visual` with a diverse choice of the grasps at one link, or of all for "".
core::Image ViewsWith(const core::TexturedMesh& visual, const manipulation::GraspSet& set,
                      const std::map<std::string, GraspedLinkView>& links,
                      const std::string& only) {
  core::TexturedMesh mesh = visual;
  mesh.triangle_part.clear();
  mesh.part_names.clear();
  if (mesh.triangle_material.empty()) {
    mesh.materials = {core::Material()};
    mesh.triangle_material.assign(mesh.mesh.triangles.size(), 0);
  }
  std::map<std::string, std::vector<manipulation::Grasp>> by_link;
  for (const manipulation::Grasp& grasp : set.grasps) {
    if (only.empty() || grasp.link == only) by_link[grasp.link].push_back(grasp);
  }
  for (const auto& [link, grasps] : by_link) {
    for (const int index : manipulation::FarthestGrasps(grasps, links.empty() ? kAll : kAtLink)) {
      core::TexturedMesh gripper = WireGripper(grasps[static_cast<size_t>(index)]);
      if (!link.empty()) {
        core::Transform(Eigen::Affine3d(links.at(link).asset_from_link), &gripper.mesh);
      }
      assets::AppendVisual(gripper, &mesh);
    }
  }
  return render::Preview(mesh);
}

}  // namespace

core::Image GraspPreview(const core::TexturedMesh& visual, const manipulation::GraspSet& set,
                         const std::map<std::string, GraspedLinkView>& links) {
  std::vector<core::Image> rows = {ViewsWith(visual, set, links, "")};
  for (const std::string& link : manipulation::GraspedLinks(set)) {
    if (rows.size() > kMostLinks) break;
    core::TexturedMesh part = links.at(link).visual;
    core::Transform(Eigen::Affine3d(links.at(link).asset_from_link), &part.mesh);
    rows.push_back(ViewsWith(part, set, links, link));
  }
  return rows.size() == 1 ? rows.front() : core::ContactSheet(rows, 1);
}

}  // namespace simwright::workflows
