#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

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

// Returns the text of a file of grasps. The grasps of an articulated asset are those of one link
// for IsaacGraspText; the others have a body or a scope for each link.
std::string IsaacGraspText(const GraspSet& set);
std::string MjcfGraspText(const GraspSet& set);
std::string UsdGraspText(const GraspSet& set);

// Returns the files of the grasps of an articulated asset at `links`: one for each link in the
// formats that know one frame of the object, "FILE_handle_0.yaml", else `file`, as for a rigid
// asset (no links).
std::vector<std::filesystem::path> GraspFiles(GraspFormat format, const std::filesystem::path& file,
                                              const std::vector<std::string>& links);

// Inertials by link, for ACRONYM's properties of the object; of a rigid asset at "".
using GraspInertials = std::map<std::string, assets::Inertial>;

// Writes the files of GraspFiles in any format and returns them. Throws core::Error for a link
// without an inertial in `inertials`.
std::vector<std::filesystem::path> WriteGrasps(const GraspSet& set, const GraspInertials& inertials,
                                               GraspFormat format,
                                               const std::filesystem::path& file);

}  // namespace simwright::manipulation
