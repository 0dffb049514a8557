#pragma once

#include <filesystem>
#include <string>

#include "assets/asset.h"
#include "manipulation/grasp_file.h"

namespace simwright::manipulation {

// The forms of a file of grasps (docs/grasps.md).
enum class GraspFormat { kJson, kIsaac, kAcronym, kMjcf, kUsd };

// Returns the format of a name (json, isaac, acronym, mjcf, usd), else that of the file's extension
// (.json, .yaml or .yml, .h5 or .hdf5, .xml, .usda). Throws core::Error for others, and for a file
// that does not end as those of the named format.
GraspFormat GraspFormatOf(const std::string& name, const std::filesystem::path& file);
// Returns the extension, with its dot.
std::string GraspExtension(GraspFormat format);

// Returns the text of a file of grasps.
std::string IsaacGraspText(const GraspSet& set);
std::string MjcfGraspText(const GraspSet& set);
std::string UsdGraspText(const GraspSet& set);

// Writes a file of any format. `asset` gives ACRONYM's properties of the object.
void WriteGrasps(const GraspSet& set, const assets::Asset& asset, GraspFormat format,
                 const std::filesystem::path& file);

}  // namespace simwright::manipulation
