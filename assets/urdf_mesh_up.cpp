#include "assets/urdf_mesh_up.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "assets/mesh_format.h"
#include "assets/mesh_import.h"

namespace simwright::assets {
namespace {

// What fits better only by less than this share of the meshes' size is no evidence.
constexpr double kClearly = 0.05;

bool IsOf(const UrdfShape& shape, bool gltf) {
  if (shape.up != 'x' && shape.up != 'y') return false;
  const MeshFormat format = MeshFormatOf(shape.file);
  return gltf == (format == MeshFormat::kGlb || format == MeshFormat::kGltf);
}

// link_from_file with the file's axes turned first.
Eigen::Affine3d Turned(const UrdfShape& shape) {
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.linear() = ZUpFrom(shape.up);
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

// How badly the links' meshes fit what is known of the links otherwise: the joints at their
// children should touch them, collisions of other origin cover the same room. Metres.
double Mismatch(const UrdfModel& model, bool gltf, bool turn) {
  double sum = 0.0;
  for (const UrdfLink& link : model.links) {
    const auto concerned = [&](const auto& shape) { return IsOf(shape, gltf); };
    const bool any = std::any_of(link.visuals.begin(), link.visuals.end(), concerned) ||
                     std::any_of(link.collisions.begin(), link.collisions.end(), concerned);
    if (!any) continue;
    const Eigen::AlignedBox3d seen = BoxOf(link.visuals, gltf, turn);
    const Eigen::AlignedBox3d hit = BoxOf(link.collisions, gltf, turn);
    const bool same_files =
        std::any_of(link.collisions.begin(), link.collisions.end(), concerned);
    if (!seen.isEmpty() && !hit.isEmpty() && !same_files) {
      sum += (seen.min() - hit.min()).cwiseAbs().sum() + (seen.max() - hit.max()).cwiseAbs().sum();
    }
    Eigen::AlignedBox3d whole = seen;
    whole.extend(hit);
    for (const UrdfJoint& joint : model.joints) {
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
  const double as_said = Mismatch(*model, gltf, true);
  const double as_lying = Mismatch(*model, gltf, false);
  const bool turn = as_said <= as_lying + kClearly * size;
  const std::string kind = gltf ? "glTF" : "DAE";
  char figures[100];
  std::snprintf(figures, sizeof(figures), " (%.3g m against %.3g m of misfit)",
                turn ? as_said : as_lying, turn ? as_lying : as_said);
  core::Finding finding{"urdf-mesh-up", core::Severity::kInfo, "", "",
                        static_cast<double>(count)};
  finding.sentence =
      turn ? kind + " meshes say that another axis than z points up and were turned to z up"
           : kind + " meshes say that another axis than z points up; they were left as they lie, "
                    "because joints and collisions fit better so" + figures;
  finding.remedy = gltf ? "Drake and Gazebo turn glTF, others do not: look at the preview"
                        : "PyBullet turns them, RViz, MoveIt and Gazebo do not: look at the "
                          "preview, and export with z up to be read alike";
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

void TurnMeshesUp(UrdfModel* model) {
  Decide(false, model);
  Decide(true, model);
}

}  // namespace simwright::assets
