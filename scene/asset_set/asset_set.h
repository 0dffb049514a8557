#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "geometry/distance.h"
#include "scene/grammar/category_size.h"
#include "sim/rigid_body.h"

namespace simwright::scene {

// The asset of a category in its forms for physics, projection, grammars and rendering; its base is
// at z = 0.
struct SceneAsset {
  sim::RigidBody body;                       // for physics
  std::vector<geometry::ConvexShape> parts;  // the same parts, for projection
  CategorySize size;                         // for grammars
  core::TexturedMesh visual;                 // for rendering
  // The asset's folder, with what was made for exactly these collision parts, such as the proved
  // grasps of grasps.json; empty: none.
  std::filesystem::path folder;
};

// An asset set: the assets of scenes by category. Thread-safe once it is filled.
class AssetSet {
 public:
  // Adds an asset. Throws core::Error for a category that exists or a body without parts. Without a
  // `visual` the parts are rendered. `folder`: SceneAsset::folder.
  void Add(const std::string& category, sim::RigidBody body, core::TexturedMesh visual = {},
           std::filesystem::path folder = {});

  // Replaces the collision parts by their convex hull: fewer contacts for a hollow asset, and no
  // object fits into it. It then has no folder. Throws as At does.
  void UseConvexHullCollision(const std::string& category);

  // Returns the asset of a category. Throws core::Error, naming the category, if there is none.
  const SceneAsset& At(const std::string& category) const;
  bool Has(const std::string& category) const { return assets_.count(category) > 0; }

  // Returns a hash of the asset's physics: parts, inertial, friction. Throws as At does.
  std::string HashOf(const std::string& category) const;

  // Returns the sizes for grammars: those of this set's assets, and those of `others` for the other
  // categories.
  CategorySizes Sizes(const CategorySizes& others = DefaultCategorySizes()) const;

 private:
  std::map<std::string, SceneAsset> assets_;
};

}  // namespace simwright::scene
