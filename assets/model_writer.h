#pragma once

#include <string>

#include "assets/asset.h"
#include "assets/hydroelastic.h"

namespace simwright::assets {

// The asset as a model of one free body, with the same numbers in each format. Mesh files are
// named relative to the model: "visual.obj", "collision_000.obj" ... Numbers are written with 17
// digits, so that each reader gets back the same doubles.
std::string UrdfText(const Asset& asset);
std::string SdfText(const Asset& asset);
// MJCF without <option> and <size>, to be attached to any model; its scene has them
// (mjcf_scene.h). The visual mesh is left out where MuJoCo would refuse it (no volume, or more than
// 200k faces): the solid stands in.
std::string MjcfText(const Asset& asset);

// How the asset touches others in Drake.
HydroelasticContact ContactOf(const Asset& asset);

// "collision_007.obj"
std::string CollisionFileName(int part);
// Whether MuJoCo's mesh compiler takes the visual mesh.
bool VisualSuitsMujoco(const core::TriangleMesh& visual);

}  // namespace simwright::assets
