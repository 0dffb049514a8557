#pragma once

#include <map>
#include <string>

#include <Eigen/Geometry>

#include "core/image.h"
#include "core/mesh.h"
#include "manipulation/grasp_file.h"

namespace simwright::workflows {

// A link that grasps hold, for pictures.
struct GraspedLinkView {
  core::TexturedMesh visual;  // link frame
  Eigen::Isometry3d asset_from_link = Eigen::Isometry3d::Identity();
};

// Returns four views of the asset with a diverse choice of grasps as wire grippers: green where all
// perturbed trials held, towards red where fewer did. `links`: those of an articulated asset by
// name; six of them at most follow below, each by itself with its grasps.
core::Image GraspPreview(const core::TexturedMesh& visual, const manipulation::GraspSet& set,
                         const std::map<std::string, GraspedLinkView>& links = {});

}  // namespace simwright::workflows
