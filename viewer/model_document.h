#pragma once

#include <filesystem>

#include "assets/articulated_asset.h"
#include "assets/asset.h"
#include "assets/urdf_reader.h"
#include "core/json.h"
#include "viewer/document.h"

namespace simwright::viewer {

// Return a model of the manifest: its links with meshes by layer (`visual`, `solid`, `parts`),
// mass, centre of mass and the box of uniform density that has the link's mass and inertia; its
// joints, joints[i] leading to links[i + 1]; and a table of facts. The meshes go into `builder`.
// Throw core::Error for an invalid mesh.
core::OrderedJson ModelOf(const assets::Asset& asset, DocumentBuilder* builder);
core::OrderedJson ModelOf(const assets::ArticulatedAsset& asset, DocumentBuilder* builder);
// Visuals that cannot be read are left out with a finding of the manifest. `name`: as shown; empty:
// the URDF's.
core::OrderedJson ModelOf(const assets::UrdfModel& model, const std::string& name,
                          DocumentBuilder* builder);
// Returns the model of a mesh file: one link without a mass.
core::OrderedJson ModelOf(const core::TexturedMesh& mesh, const std::string& name,
                          DocumentBuilder* builder);

// A box of uniform density with the mass and inertia of an inertial.
struct EquivalentBox {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();                   // m
  Eigen::Isometry3d link_from_box = Eigen::Isometry3d::Identity();  // its centre and axes
};

// Returns the equivalent box: side i is sqrt(6 (I_j + I_k - I_i) / m) for the principal moments I.
// Its size is zero where the mass is not positive.
EquivalentBox EquivalentBoxOf(const assets::Inertial& inertial);

// Adds a finding to the manifest, unless it is there already.
void AddFinding(const core::Finding& finding, DocumentBuilder* builder);

}  // namespace simwright::viewer
