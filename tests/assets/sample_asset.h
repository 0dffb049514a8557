#pragma once

#include "assets/asset.h"
#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"

namespace simwright::assets {

// A box of 6 x 4 x 10 cm and 0.3 kg, its centre of mass off the middle, standing on z = 0.
inline Asset SampleAsset() {
  Asset asset;
  asset.name = "sample_box";
  asset.parameters.category = "box";
  asset.parameters.material = "wood";
  asset.visual.mesh = BoxMesh({0.06, 0.04, 0.1});
  for (Eigen::Vector3d& v : asset.visual.mesh.vertices) v += Eigen::Vector3d(0.01, 0.0, 0.05);
  asset.visual.materials.push_back({"painted wood", {0.8f, 0.3f, 0.1f, 1.0f}, -1});
  asset.visual.triangle_material.assign(asset.visual.mesh.triangles.size(), 0);
  asset.visual.part_names = {"body"};
  asset.visual.triangle_part.assign(asset.visual.mesh.triangles.size(), 0);
  asset.solid = asset.visual.mesh;
  asset.parts = {asset.solid};
  const geometry::MassProperties m = geometry::SolidMassProperties(asset.solid, 1250.0);
  asset.inertial = {m.mass, m.center_of_mass, m.inertia};
  // A full tensor, as for a rotated body.
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  asset.inertial.inertia = R * asset.inertial.inertia * R.transpose();
  asset.inertial.inertia =
      (0.5 * (asset.inertial.inertia + asset.inertial.inertia.transpose())).eval();
  asset.volume = m.volume;
  asset.density = 1250.0;
  asset.source = "test";
  return asset;
}

}  // namespace simwright::assets
