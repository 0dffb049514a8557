#pragma once

#include <string>
#include <vector>

#include "assets/world_writer.h"

namespace simwright::scene {

// Where an exported scene comes from.
struct ExportedScene {
  std::string name;  // "scene_00012"
  std::string type;  // "dimsum"
  int index = 0;     // in its dataset
  std::vector<assets::WorldThing> things;
};

// The scene as JSON (docs/formats.md): of each thing its URDF, slot, pose and whether it is welded.
// Numbers read back as the same doubles.
std::string SceneJson(const ExportedScene& scene);

// Model directives of Drake, YAML: an `add_model` for each thing, of the asset's SDF, whose
// friction Drake reads; what is free gets its `default_free_body_pose`, what is welded an
// `add_weld` to the world with `X_PC`. Rotations are `!AngleAxis`, numbers of 17 digits. Files are
// package://PACKAGE/assets/SLOT/..., as Drake's package map finds them.
std::string DrakeDirectives(const ExportedScene& scene, const std::string& package);

// package.xml, by which Drake finds the files of `package`.
std::string PackageXml(const std::string& package);

}  // namespace simwright::scene
