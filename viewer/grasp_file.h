#pragma once

#include <filesystem>
#include <vector>

#include "core/json.h"

namespace simwright::viewer {

// Reads the grasps of an asset from a JSON file as `simwright grasps` and GraspGen write it. Poses
// are those of the tool in the object's frame: z along the approach, y from finger to finger, the
// origin between the fingertips. They are `grasps.tool_transforms` (N x 4 x 4) or, where the file
// has none, follow from `grasps.transforms`, the poses of a Panda's hand in GraspGen's frame: x
// from finger to finger, the origin 0.1034 m behind the fingertips. Qualities are those of
// `grasps.quality` or `grasps.object_in_gripper` (N), openings (m) those of `grasps.opening_m`.
// Poses at links of an articulated asset are in the frames of `grasps.link` (N, names).
// Returns {"count", "shown", "poses" (N x 12), "qualities" (N, 1 where the file has none),
// "openings" (N, that of the Panda where the file has none), "links" (N, names, where the file has
// them)} with at most `most` grasps, those of
// the highest quality. Throws core::Error, naming the file and the member, for another form, and
// for transforms that are no rigid motion.
core::OrderedJson ReadGrasps(const std::filesystem::path& file, std::size_t most = 400);

}  // namespace simwright::viewer
