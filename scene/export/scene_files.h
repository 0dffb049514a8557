#pragma once

#include <string>
#include <vector>

#include "assets/world_writer.h"

namespace simwright::scene {

// An exported scene with its origin.
struct ExportedScene {
  std::string name;  // "scene_00012"
  std::string type;  // "dimsum"
  int index = 0;     // in its dataset
  std::vector<assets::WorldObject> objects;
};

// Returns the scene as JSON (docs/formats.md): the URDF, category, pose and welded flag of each
// object. Numbers parse to the same doubles.
std::string SceneJson(const ExportedScene& scene);

// Returns the scene as Drake model directives (YAML): one `add_model` per object with the asset's
// SDF, from which Drake reads the friction; free objects have a `default_free_body_pose`, welded
// ones an `add_weld` to the world with `X_PC`. Rotations are `!AngleAxis`, numbers have 17 digits.
// File URIs are package://PACKAGE/assets/SLOT/..., resolved by Drake's package map.
std::string DrakeDirectives(const ExportedScene& scene, const std::string& package);

// Returns the package.xml by which Drake finds the files of `package`.
std::string PackageXml(const std::string& package);

}  // namespace simwright::scene
