#pragma once

#include <string>
#include <vector>

#include "assets/articulated_asset.h"
#include "assets/hydroelastic.h"

namespace simwright::assets {

// A visual of one colour, as it is written to a file of its own: every viewer of URDF and MJCF
// then shows its colour.
struct ColoredPiece {
  std::string stem;  // "door_visual_000"
  core::TexturedMesh mesh;
};

// The link's visual, a piece a material. Throws core::Error where it has textures.
std::vector<ColoredPiece> ColoredPieces(const ArticulatedLink& link);

// How the link touches others in Drake.
HydroelasticContact ContactOf(const ArticulatedAsset& asset, const ArticulatedLink& link);

// "door_collision_007.obj"
std::string LinkCollisionFileName(const std::string& link, int part);

// The asset as a tree of links, with the same numbers in both formats. Mesh files are named
// relative to the model. In MJCF a link on a fixed joint stays a body of its own, so that its pose
// can be asked for; joint friction holds what is below it to less than 1e-4 rad/s; there is no
// <option> or <size>, so that it can be attached to any model (mjcf_scene.h).
std::string ArticulatedUrdfText(const ArticulatedAsset& asset);
std::string ArticulatedMjcfText(const ArticulatedAsset& asset);

// PartNet-Mobility's semantics.txt: "door hinge door", a line a link. The root is "free" or, where
// the asset is fixed, "static".
std::string SemanticsText(const ArticulatedAsset& asset);

// "hinge", "slider", "fixed" ... as semantics.txt calls a joint.
std::string SemanticsKind(UrdfJointType type);
// "revolute" ... as URDF calls it; the other way round throws core::Error for an unknown one.
std::string JointTypeName(UrdfJointType type);
UrdfJointType JointTypeNamed(const std::string& name);

}  // namespace simwright::assets
