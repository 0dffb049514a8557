#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "certificate/placed_scene.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::certificate {

// The places of the proved grasps of bodies.
struct ProvedGraspFiles {
  bool use = true;
  // The folder of NAME/grasps.json or NAME.json for an asset whose own folder is called NAME;
  // empty: grasps.json in the asset's own folder.
  std::filesystem::path folder = {};
  std::string gripper = "panda";  // grasps of other grippers are left out
};

// Returns the proved grasps of an asset whose folder is `asset`; none without a file, and for
// another gripper. Throws core::Error for a damaged file.
std::vector<manipulation::Grasp> ProvedGraspsOfAsset(const std::filesystem::path& asset,
                                                     const ProvedGraspFiles& files);

// The bodies of an asset set, each made once. Thread-safe.
class SceneBodies {
 public:
  // `asset_set` must outlive this.
  explicit SceneBodies(const scene::AssetSet& asset_set, ProvedGraspFiles files = {})
      : asset_set_(asset_set), files_(std::move(files)) {}

  // Returns the body of a category, with the proved grasps of its asset. Throws core::Error if the
  // category has no asset, and for a damaged file of grasps.
  std::shared_ptr<const BodyModel> At(const std::string& category) const;
  // Returns the scene of `objects`; `names` by object, or empty: "apple_0", by category and number.
  PlacedScene SceneOf(const std::vector<scene::SceneObject>& objects,
                      const std::vector<std::string>& names = {}) const;

 private:
  const scene::AssetSet& asset_set_;
  ProvedGraspFiles files_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<const BodyModel>> bodies_;
};

}  // namespace simwright::certificate
