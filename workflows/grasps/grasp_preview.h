#pragma once

#include "assets/asset.h"
#include "core/image.h"
#include "manipulation/grasp_file.h"

namespace simwright::workflows {

// Returns four views of the asset with a diverse choice of `count` grasps as wire grippers: green
// where all perturbed trials held, towards red where fewer did.
core::Image GraspPreview(const assets::Asset& asset, const manipulation::GraspSet& set,
                         int count = 24);

}  // namespace simwright::workflows
