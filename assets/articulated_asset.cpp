#include "assets/articulated_asset.h"

#include <algorithm>
#include <utility>

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

void AppendVisual(const core::TexturedMesh& addition, core::TexturedMesh* visual) {
  const size_t before = visual->mesh.triangles.size();
  core::Append(addition.mesh, &visual->mesh);
  const int first = static_cast<int>(visual->materials.size());
  for (const int material : addition.triangle_material) {
    visual->triangle_material.push_back(first + material);
  }
  std::vector<int> texture_of(addition.textures.size());
  for (size_t i = 0; i < addition.textures.size(); ++i) {
    const auto same = [&](const core::Image& known) {
      const core::Image& texture = addition.textures[i];
      return known.width == texture.width && known.channels == texture.channels &&
             known.pixels == texture.pixels;
    };
    const auto known = std::find_if(visual->textures.begin(), visual->textures.end(), same);
    texture_of[i] = static_cast<int>(known - visual->textures.begin());
    if (known == visual->textures.end()) visual->textures.push_back(addition.textures[i]);
  }
  for (core::Material material : addition.materials) {
    if (material.texture >= 0) material.texture = texture_of[static_cast<size_t>(material.texture)];
    visual->materials.push_back(std::move(material));
  }
  // Texture coordinates are those of all triangles or of none.
  if (visual->corner_uvs.empty() && addition.corner_uvs.empty()) return;
  visual->corner_uvs.resize(3 * before, Eigen::Vector2f::Zero());
  visual->corner_uvs.insert(visual->corner_uvs.end(), addition.corner_uvs.begin(),
                            addition.corner_uvs.end());
  visual->corner_uvs.resize(3 * visual->mesh.triangles.size(), Eigen::Vector2f::Zero());
}

core::TexturedMesh VisualAtPositions(const ArticulatedAsset& asset,
                                     const std::map<std::string, double>& positions) {
  const std::vector<Eigen::Isometry3d> poses = LinkPoses(ModelOf(asset), positions);
  core::TexturedMesh whole;
  for (size_t i = 0; i < asset.links.size(); ++i) {
    core::TexturedMesh posed = asset.links[i].visual;
    core::Transform(Eigen::Affine3d(poses[i]), &posed.mesh);
    AppendVisual(posed, &whole);
  }
  return whole;
}

Eigen::AlignedBox3d BoundsAtZero(const ArticulatedAsset& asset) {
  return core::Bounds(VisualAtPositions(asset).mesh);
}

}  // namespace simwright::assets
