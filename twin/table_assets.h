#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::twin {

// An asset of the user that may stand on a table.
struct TableAsset {
  std::filesystem::path folder;
  std::string name;  // of its folder
  std::string category;
  bool articulated = false;
  core::TexturedMesh visual;  // asset frame: m, z up, standing on z = 0; joints at zero
  Eigen::Vector3d size{0, 0, 0};
};

// Reads asset folders, and the asset folders in other folders. Those of 1 cm to 80 cm are returned,
// in the order of their names, without robots; others and damaged ones are left out with the
// finding "twin-asset-unused". Throws core::Error for a path that does not exist or holds no asset,
// and for more than 200 assets.
std::vector<TableAsset> ReadTableAssets(const std::vector<std::filesystem::path>& folders,
                                        core::Findings* findings);

}  // namespace simwright::twin
