#include "assets/urdf_up_axis.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "assets/mesh_format.h"
#include "assets/mesh_import.h"

namespace simwright::assets {
namespace {

// A smaller advantage, as a share of the meshes' size, is no evidence.
constexpr double kMinAdvantage = 0.05;

bool IsOf(const UrdfShape& shape, bool gltf) {
  if (shape.up != 'x' && shape.up != 'y') return false;
  const MeshFormat format = MeshFormatOf(shape.file);
  return gltf == (format == MeshFormat::kGlb || format == MeshFormat::kGltf);
}

// Returns link_from_file preceded by the rotation to z up.
Eigen::Affine3d Turned(const UrdfShape& shape) {
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.linear() = ZUpRotation(shape.up);
  return shape.link_from_file * turn;
}

void Turn(UrdfShape* shape) {
  const Eigen::Affine3d turned = Turned(*shape);
  core::Transform(turned * shape->link_from_file.inverse(), &shape->mesh);
  shape->link_from_file = turned;
}

Eigen::AlignedBox3d BoxOf(const UrdfShape& shape, bool gltf, bool turn) {
  if (!turn || !IsOf(shape, gltf)) return core::Bounds(shape.mesh);
  core::TriangleMesh mesh{shape.mesh.vertices, {}};
  const Eigen::Affine3d change = Turned(shape) * shape.link_from_file.inverse();
  for (Eigen::Vector3d& v : mesh.vertices) v = change * v;
  return core::Bounds(mesh);
}

Eigen::AlignedBox3d BoxOf(const std::vector<UrdfShape>& shapes, bool gltf, bool turn) {
  Eigen::AlignedBox3d box;
  for (const UrdfShape& shape : shapes) box.extend(BoxOf(shape, gltf, turn));
  return box;
}

// Returns the misfit of the links' meshes to their other data, metres: the child joints should
// touch the meshes, and collisions from other sources should fill the same AABB.
double Mismatch(const UrdfModel& model, bool gltf, bool turn) {
  double sum = 0.0;
  for (const UrdfLink& link : model.links) {
    const auto concerned = [&](const auto& shape) { return IsOf(shape, gltf); };
    const bool any = std::any_of(link.visuals.begin(), link.visuals.end(), concerned) ||
                     std::any_of(link.collisions.begin(), link.collisions.end(), concerned);
    if (!any) continue;
    const Eigen::AlignedBox3d seen = BoxOf(link.visuals, gltf, turn);
    const Eigen::AlignedBox3d hit = BoxOf(link.collisions, gltf, turn);
    const bool same_files = std::any_of(link.collisions.begin(), link.collisions.end(), concerned);
    if (!seen.isEmpty() && !hit.isEmpty() && !same_files) {
      sum += (seen.min() - hit.min()).cwiseAbs().sum() + (seen.max() - hit.max()).cwiseAbs().sum();
    }
    Eigen::AlignedBox3d whole = seen;
    whole.extend(hit);
    for (const Joint& joint : model.joints) {
      if (joint.parent == link.name) {
        sum += whole.exteriorDistance(Eigen::Vector3d(joint.parent_from_joint.translation()));
      }
      if (joint.child == link.name) sum += whole.exteriorDistance(Eigen::Vector3d(0, 0, 0));
    }
  }
  return sum;
}

void Decide(bool gltf, UrdfModel* model) {
  int count = 0;
  double size = 0.0;
  for (const UrdfLink& link : model->links) {
    for (const auto* shapes : {&link.visuals, &link.collisions}) {
      for (const UrdfShape& shape : *shapes) {
        if (!IsOf(shape, gltf)) continue;
        ++count;
        size = std::max(size, core::Bounds(shape.mesh).diagonal().norm());
      }
    }
  }
  if (count == 0) return;
  const double rotated_misfit = Mismatch(*model, gltf, true);
  const double unrotated_misfit = Mismatch(*model, gltf, false);
  const bool turn = rotated_misfit <= unrotated_misfit + kMinAdvantage * size;
  const std::string kind = gltf ? "glTF" : "DAE";
  char figures[100];
  std::snprintf(figures, sizeof(figures), " (%.3g m against %.3g m of misfit)",
                turn ? rotated_misfit : unrotated_misfit, turn ? unrotated_misfit : rotated_misfit);
  core::Finding finding{"urdf-mesh-up", core::Severity::kInfo, "", "", static_cast<double>(count)};
  finding.sentence = turn ? kind + " meshes declare another up axis than z and were rotated to z up"
                          : kind +
                                " meshes declare another up axis than z; they were not rotated, "
                                "because joints and collisions fit better without" +
                                figures;
  finding.remedy = gltf ? "Drake and Gazebo rotate glTF, others do not: check the preview"
                        : "PyBullet rotates them, RViz, MoveIt and Gazebo do not: check the "
                          "preview, and export with z up for the same result everywhere";
  if (!turn) finding.severity = core::Severity::kWarning;
  model->findings.push_back(finding);
  if (!turn) return;
  for (UrdfLink& link : model->links) {
    for (auto* shapes : {&link.visuals, &link.collisions}) {
      for (UrdfShape& shape : *shapes) {
        if (IsOf(shape, gltf)) Turn(&shape);
      }
    }
  }
}

}  // namespace

void RotateMeshesToZUp(UrdfModel* model) {
  Decide(false, model);
  Decide(true, model);
}

}  // namespace simwright::assets
