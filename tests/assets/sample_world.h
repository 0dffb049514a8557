#pragma once

#include <filesystem>
#include <list>
#include <vector>

#include "assets/asset_folder.h"
#include "assets/world_writer.h"
#include "tests/assets/sample_asset.h"

namespace simwright::assets {

// Two boxes that share an asset, one pitched by 90 degrees, and a welded one of another, whose
// files lie in folder/assets; worlds are written into folder/scene.
struct SampleWorld {
  explicit SampleWorld(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "scene");
    const WorldAsset* const box = AddAsset(folder, "box", "../assets/box/");
    const WorldAsset* const shelf = AddAsset(folder, "shelf", "../assets/shelf/");
    Add("shelf_0", shelf, {0.0, 0.0, 0.0}, 0.3, true);
    Add("box_0", box, {0.31234567890123456, -0.2, 0.0}, -2.7, false);
    Add("box_1", box, {-0.4, 0.1, 0.3}, 0.0, false);
    objects.back().world_from_object.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()));
  }

  std::list<WorldAsset> assets;
  std::vector<WorldObject> objects;

 private:
  const WorldAsset* AddAsset(const std::filesystem::path& folder, const std::string& key,
                             const std::string& relative) {
    assets.push_back({key, relative, SampleAsset()});
    std::filesystem::create_directories(folder / "assets" / key);
    WriteAsset(assets.back().asset, folder / "assets" / key);
    return &assets.back();
  }
  void Add(const std::string& name, const WorldAsset* asset, const Eigen::Vector3d& place,
           double yaw, bool welded) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d(0.1, 0.0, 1.0).normalized()));
    pose.translation() = place;
    objects.push_back({name, asset, pose, welded});
  }
};

}  // namespace simwright::assets
