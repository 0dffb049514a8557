#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "assets/urdf_reader.h"

namespace simwright::assets {

// GAPartNet's URDF, in which handles are links of their own.
constexpr const char* kGapartnetUrdf = "mobility_annotation_gapartnet.urdf";

// What a link is, as PartNet-Mobility's semantics.txt says it.
struct LinkSemantics {
  std::string joint;  // hinge, slider, slider+, free, heavy, static, fixed; may be empty
  std::string label;  // door, handle, drawer, lid, knob, button ...
};

// A URDF with what is known of its meaning.
struct SemanticModel {
  std::string name;      // of its folder; of the file where it is no asset's folder
  std::string category;  // "microwave", by asset.json or meta.json; may be empty
  std::filesystem::path urdf;
  UrdfModel model;
  std::map<std::string, LinkSemantics> semantics;  // by link; links without any are left out
};

// The URDF of an asset's folder (ours, PartNet-Mobility's, GAPartNet's): the one of the folder's
// name, mobility.urdf, mobility_annotation_gapartnet.urdf, or the only one; of a ROS or Gazebo
// package, or a folder with none of its own, the only one in the folders below. Throws core::Error
// where there is none (it says so where there is a xacro) or several, which it names.
std::filesystem::path UrdfIn(const std::filesystem::path& folder);

// All files with that ending in the folder and below it, sorted; links and hidden folders are not
// followed. `ending` has its dot.
std::vector<std::filesystem::path> FilesBelow(const std::filesystem::path& folder,
                                              const std::string& ending);

// Reads a folder or a URDF, and beside it asset.json or meta.json, semantics.txt or
// semantics_gapartnet.txt (the latter first for GAPartNet's URDF), where they are there. Labels
// that no file gives come from the names of links (docs/formats.md). Lines of the semantics that
// cannot be read, or name no link, are reported in model.findings. Throws what ReadUrdf throws.
SemanticModel ReadSemanticModel(const std::filesystem::path& path,
                                const UrdfReadOptions& options = {});

}  // namespace simwright::assets
