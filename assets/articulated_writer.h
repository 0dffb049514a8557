#pragma once

#include <string>
#include <vector>

#include "assets/articulated_asset.h"
#include "assets/hydroelastic.h"

namespace simwright::assets {

// A visual of one material, written to a file of its own, so that every viewer of URDF and MJCF
// shows its colour.
struct ColoredPiece {
  std::string stem;  // "door_visual_000"
  core::TexturedMesh mesh;
  // The file name of its texture, made from the pixels, so that pieces of one texture share a file;
  // empty for a plain colour.
  std::string texture;
};

// Returns the link's visual, one piece per material.
std::vector<ColoredPiece> ColoredPieces(const ArticulatedLink& link);

// Returns the link's hydroelastic contact properties for Drake.
HydroelasticContact ContactOf(const ArticulatedAsset& asset, const ArticulatedLink& link);

// Returns "door_collision_007.obj".
std::string LinkCollisionFileName(const std::string& link, int part);

// Return the asset as a tree of links, with the same numbers in both formats. Mesh files are named
// relative to the model. In MJCF a link on a fixed joint remains a separate body, so that its pose
// can be queried; joint friction limits the creep of what it carries to less than 1e-4 rad/s; there
// is no <option> or <size>, so that the model can be attached to any other (mjcf_scene.h).
std::string ArticulatedUrdfText(const ArticulatedAsset& asset);
std::string ArticulatedMjcfText(const ArticulatedAsset& asset);

// Returns PartNet-Mobility's semantics.txt: one line "door hinge door" per link. The root is
// "free", or "static" if the asset is fixed.
std::string SemanticsText(const ArticulatedAsset& asset);

// Returns a joint's type as named in semantics.txt: "hinge", "slider", "fixed" ...
std::string SemanticsKind(JointType type);
// Convert between a joint's type and its URDF name ("revolute" ...). JointTypeNamed throws
// core::Error for an unknown name.
std::string JointTypeName(JointType type);
JointType JointTypeNamed(const std::string& name);

}  // namespace simwright::assets
