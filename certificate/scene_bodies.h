#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "certificate/placed_scene.h"
#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::certificate {

// The bodies of an asset set, each made once. Thread-safe.
class SceneBodies {
 public:
  // `asset_set` must outlive this.
  explicit SceneBodies(const scene::AssetSet& asset_set) : asset_set_(asset_set) {}

  // Returns the body of a category. Throws core::Error if it has no asset.
  std::shared_ptr<const BodyModel> At(const std::string& category) const;
  // Returns the scene of `objects`; `names` by object, or empty: "apple_0", by category and number.
  PlacedScene SceneOf(const std::vector<scene::SceneObject>& objects,
                      const std::vector<std::string>& names = {}) const;

 private:
  const scene::AssetSet& asset_set_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<const BodyModel>> bodies_;
};

}  // namespace simwright::certificate
