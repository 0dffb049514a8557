#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "assets/urdf_reader.h"

namespace simwright::assets {

// GAPartNet's URDF, in which handles are separate links.
constexpr const char* kGapartnetUrdf = "mobility_annotation_gapartnet.urdf";

// A link's semantics as in PartNet-Mobility's semantics.txt.
struct LinkSemantics {
  std::string joint;  // hinge, slider, slider+, free, heavy, static, fixed; may be empty
  std::string label;  // door, handle, drawer, lid, knob, button ...
};

// A URDF with its semantic annotations.
struct SemanticModel {
  std::string name;      // name of the asset's folder, otherwise of the file
  std::string category;  // "microwave", from asset.json or meta.json; may be empty
  std::filesystem::path urdf;
  UrdfModel model;
  std::map<std::string, LinkSemantics> semantics;  // by link; links without any are omitted
  // True if a proved grasp takes the object off the plane on which it stands, false if none of its
  // proved grasps does. None: no grasps are known (ReadSemanticModel leaves it so).
  std::optional<bool> graspable = std::nullopt;
};

// Returns the URDF of an asset's folder (ours, PartNet-Mobility's, GAPartNet's): the one with the
// folder's name, mobility.urdf, mobility_annotation_gapartnet.urdf, or the only one. For a ROS or
// Gazebo package, or a folder without a URDF of its own, returns the only one in its subfolders.
// Throws core::Error if there is none (it reports a xacro) or if there are several, which it names.
std::filesystem::path UrdfIn(const std::filesystem::path& folder);

// Returns all files with that extension in the folder and its subfolders, sorted; links and hidden
// folders are not followed. `ending` includes its dot.
std::vector<std::filesystem::path> FilesBelow(const std::filesystem::path& folder,
                                              const std::string& ending);

// Reads a folder or a URDF, and, if present, asset.json or meta.json, semantics.txt or
// semantics_gapartnet.txt beside it (the latter first for GAPartNet's URDF). Labels that no file
// gives are derived from link names (docs/formats.md). Lines of the semantics that cannot be read,
// or name no link, are reported in model.findings. Throws the exceptions of ReadUrdf.
SemanticModel ReadSemanticModel(const std::filesystem::path& path,
                                const UrdfReadOptions& options = {});

}  // namespace simwright::assets
