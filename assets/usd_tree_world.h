#pragma once

#include <map>
#include <string>
#include <vector>

#include "assets/tree_world.h"
#include "core/mesh.h"

namespace simwright::assets {

// Returns a world of articulated and rigid bodies as one layer of OpenUSD, with the floor z = 0 and
// gravity. `meshes` are those of the shapes' files, by TreeShape::file; the layer holds them.
//
// Links are placed as at the start, whose joint positions are also stated by PhysicsJointStateAPI
// (degrees or m). A motor is a drive with the motor's stiffness, target and greatest force; its
// damping is the motor's and the joint's. Links of one body do not collide; capsules stay capsules.
// A fixed body without joints is no rigid body: its shapes are static. That the friction of a link
// prevails is left out, as USD cannot say it.
//
// Throws core::Error for more than 28 bodies, for names as TreeWorldMjcf, and if the mesh of a
// shape is missing.
std::string TreeWorldUsd(const std::string& name, const std::vector<TreeBody>& bodies,
                         const std::map<std::string, const core::TriangleMesh*>& meshes);

}  // namespace simwright::assets
