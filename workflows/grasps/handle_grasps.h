#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "manipulation/grasp_formats.h"
#include "manipulation/parallel_gripper.h"
#include "workflows/grasps/grasp_making.h"

namespace simwright::workflows {

// The files that the grasps of an asset are written to.
struct GraspOutput {
  std::filesystem::path file, picture;
  manipulation::GraspFormat format = manipulation::GraspFormat::kJson;
};

// Returns the links of an articulated asset that hands may hold (manipulation::HandlesOf), each
// once.
std::vector<std::string> HandleLinks(const std::filesystem::path& folder);

// Samples and proves the grasps of the joints of an articulated asset, and writes them and their
// picture. Throws core::Error if no joint can be gripped, saying why.
GraspReport HandleGraspsOf(const std::filesystem::path& folder,
                           const manipulation::ParallelGripper& gripper,
                           const GraspRequest& request, const GraspOutput& output,
                           core::Progress* progress);

// Returns the number of joints with grasps.
int GrippedJoints(const manipulation::GraspSet& set);

}  // namespace simwright::workflows
