#pragma once

#include <filesystem>
#include <vector>

#include "certificate/proof.h"
#include "core/progress.h"
#include "robot/robot_model.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::workflows {

// The replay of one scene, to be rendered.
struct CertificateView {
  const std::vector<scene::SceneObject>* objects;
  const std::vector<certificate::ReplayMoment>* moments;  // poses by object
  Eigen::Isometry3d world_from_robot;
};

// Renders a row of each scene's moments, the robot among the objects, into one PNG; writes nothing
// without views. All views need the same number of moments.
void WriteCertificateSheet(const std::vector<CertificateView>& views,
                           const scene::AssetSet& asset_set, const robot::RobotModel& robot,
                           const std::filesystem::path& path, core::Progress* progress);

}  // namespace simwright::workflows
