#pragma once

#include <string>

#include "assets/asset.h"
#include "assets/hydroelastic.h"

namespace simwright::assets {

// Return the text of a model (URDF, SDF or MJCF) in which the asset is one free body. All formats
// have the same numbers, written with 17 digits so that each reader recovers the same doubles. Mesh
// files are named relative to the model's file: "visual.obj", "collision_000.obj" ...
std::string UrdfText(const Asset& asset);
std::string SdfText(const Asset& asset);
// Returns the MJCF without <option> and <size>, so that it can be attached to any other model; the
// scene file has both (mjcf_scene.h). If MuJoCo would reject the visual mesh (VisualSuitsMujoco),
// the MJCF names "solid.obj" in its place.
std::string MjcfText(const Asset& asset);

// Returns the asset's hydroelastic contact properties for Drake.
HydroelasticContact ContactOf(const Asset& asset);

// Returns the file name of collision part `part`: "collision_007.obj" for 7.
std::string CollisionFileName(int part);
// Returns true if MuJoCo's mesh compiler accepts the visual mesh: it has a volume and at most 200k
// faces.
bool VisualSuitsMujoco(const core::TriangleMesh& visual);

}  // namespace simwright::assets
