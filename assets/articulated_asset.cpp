#include "assets/articulated_asset.h"

#include "assets/joint_poses.h"
#include "core/error.h"
#include "geometry/mass_properties.h"

namespace simwright::assets {

bool IsRobot(const ArticulatedAsset& asset) {
  const auto found = asset.features.find(kKindFeature);
  return found != asset.features.end() && found->second == kRobotKind;
}

UrdfModel ModelOf(const ArticulatedAsset& asset) {
  UrdfModel model;
  model.name = asset.name;
  model.joints = asset.joints;
  model.excluded_pairs = asset.excluded_pairs;
  for (const ArticulatedLink& link : asset.links) {
    UrdfLink& copy = model.links.emplace_back();
    copy.name = link.name;
    copy.inertial = link.inertial;
    copy.friction = link.friction;
    copy.restitution = link.restitution;
    for (const core::TriangleMesh& part : link.parts) copy.collisions.push_back({part, ""});
  }
  return model;
}

Inertial CombinedInertial(const UrdfModel& model, const std::map<std::string, double>& positions) {
  const std::vector<Eigen::Isometry3d> poses = LinkPoses(model, positions);
  geometry::MassProperties total;
  for (size_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].inertial) continue;
    const Inertial& inertial = *model.links[i].inertial;
    const geometry::MassProperties one = geometry::Transformed(
        poses[i], {0.0, inertial.mass, inertial.center_of_mass, inertial.inertia});
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
  }
  if (!(total.mass > 0.0)) {
    throw core::Error("no link has a mass", model.name, "add <inertial> elements");
  }
  return {total.mass, total.center_of_mass, total.inertia};
}

core::TexturedMesh VisualAtPositions(const ArticulatedAsset& asset,
                                     const std::map<std::string, double>& positions) {
  const std::vector<Eigen::Isometry3d> poses = LinkPoses(ModelOf(asset), positions);
  core::TexturedMesh whole;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    const core::TexturedMesh& visual = asset.links[i].visual;
    core::TriangleMesh posed = visual.mesh;
    core::Transform(Eigen::Affine3d(poses[i]), &posed);
    core::Append(posed, &whole.mesh);
    const int first = static_cast<int>(whole.materials.size());
    for (const int material : visual.triangle_material) {
      whole.triangle_material.push_back(first + material);
    }
    whole.materials.insert(whole.materials.end(), visual.materials.begin(), visual.materials.end());
  }
  return whole;
}

Eigen::AlignedBox3d BoundsAtZero(const ArticulatedAsset& asset) {
  return core::Bounds(VisualAtPositions(asset).mesh);
}

}  // namespace simwright::assets
