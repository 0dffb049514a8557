#pragma once

#include <filesystem>
#include <vector>

#include "core/json.h"

namespace simwright::viewer {

// Reads the grasps of an asset from a JSON file as `simwright grasps` and GraspGen write it:
// `grasps.transforms` (N x 4 x 4, the tool in the object's frame: z along the approach, y from
// finger to finger), and, where there are such, `grasps.quality` or `grasps.object_in_gripper` (N).
// Returns {"count", "shown", "poses" (N x 12), "qualities" (N, 1 where the file has none)} with at
// most `most` of them, those of the highest quality. Throws core::Error, naming the file and the
// member, for another form, and for transforms that are no rigid motion.
core::OrderedJson ReadGrasps(const std::filesystem::path& file, std::size_t most = 400);

}  // namespace simwright::viewer
