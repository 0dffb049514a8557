#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "manipulation/grasp_file.h"

namespace simwright::workflows {

struct GraspRequest {
  std::vector<std::filesystem::path> assets;  // folders of assets, rigid or articulated
  std::string gripper = "panda";              // or the file of a URDF
  int count = 200;                            // grasps per asset, at most; its joints share them
  std::string format;                         // json, isaac, acronym, mjcf, usd; empty: of `output`
  // The file to write, for one asset. Empty: grasps.json (or of `format`) in each asset's folder.
  std::filesystem::path output;
  std::uint64_t seed = 1;
  bool force = false;  // replaces existing files
};

struct GraspReport {
  std::string asset;
  std::filesystem::path file, picture;       // empty if there are no grasps
  std::vector<std::filesystem::path> files;  // all, where each link has one; the first is `file`
  manipulation::GraspSet set;
  int candidates = 0;
  double seconds = 0.0;
  std::string error;  // why there are none, if so
  core::Findings findings;
};

// Samples and proves the grasps of assets, and writes them with a picture beside each file. Those
// of an articulated asset move its joints (manipulation::HandlesOf); a joint without any is a
// finding. Throws core::Error for a wrong request, an existing file, and if the only asset has no
// grasps.
std::vector<GraspReport> MakeGrasps(const GraspRequest& request, core::Progress* progress);

std::string GraspTable(const std::vector<GraspReport>& reports);
std::string GraspReportsJson(const std::vector<GraspReport>& reports);

// Returns a rigid asset as an object of grasps: friction is the low end of its range.
manipulation::GraspObject GraspObjectOf(const assets::Asset& asset);

}  // namespace simwright::workflows
