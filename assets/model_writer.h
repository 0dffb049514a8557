#pragma once

#include <string>

#include "assets/asset.h"
#include "assets/hydroelastic.h"

namespace simwright::assets {

// Return the asset as a model of one free body, with the same numbers in each format. Mesh files
// are named relative to the model: "visual.obj", "collision_000.obj" ... Numbers are written with
// 17 digits, so that each reader recovers the same doubles.
std::string UrdfText(const Asset& asset);
std::string SdfText(const Asset& asset);
// Returns the MJCF without <option> and <size>, so that it can be attached to any model; its scene
// has them (mjcf_scene.h). If MuJoCo would reject the visual mesh (no volume, or more than 200k
// faces), the solid replaces it.
std::string MjcfText(const Asset& asset);

// Returns the asset's hydroelastic contact properties for Drake.
HydroelasticContact ContactOf(const Asset& asset);

// Returns "collision_007.obj".
std::string CollisionFileName(int part);
// Returns true if MuJoCo's mesh compiler accepts the visual mesh.
bool VisualSuitsMujoco(const core::TriangleMesh& visual);

}  // namespace simwright::assets
