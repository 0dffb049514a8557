#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/finding.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/vocabulary.h"
#include "workflows/scenes/scene_source.h"

namespace simwright::workflows {

// The role of an asset in scenes that a model steers.
struct AssetRole {
  std::string key;       // the category of its objects in the output
  int model_class = -1;  // the class of the model's vocabulary; -1: the model does not know it
  bool welded = false;   // fixed in physics
};

// Assigns the assets of source scenes to the classes of a model, and collects their folders. An
// asset's class is that of its slot's name, its folder's name with or without a seed ("apple_7"),
// or its category. Where two assets have one class, or one is welded unlike its class, the second
// gets a key of its own ("cup-2"). An asset without a class is an obstacle: fixed, and not seen by
// the model.
class SourceAssets {
 public:
  // `vocabulary` outlives this.
  explicit SourceAssets(const scene::Vocabulary* vocabulary) : vocabulary_(vocabulary) {}

  // Returns the role of an object's asset. Throws core::Error if an asset without a known name
  // cannot be read.
  const AssetRole& RoleOf(const SourceObject& object);

  const scene::CategoryFolders& folders() const { return folders_; }  // by key
  // Returns one finding that names the assets that the model does not know, or none.
  core::Findings UnknownFindings() const;

  // Returns the model's vocabulary extended by the keys that it lacks; at least `entries` long.
  scene::Vocabulary ExtendedVocabulary(int entries) const;

 private:
  int ClassOf(const SourceObject& object) const;
  std::string KeyOf(const std::string& base) const;

  const scene::Vocabulary* vocabulary_;
  std::map<std::pair<std::filesystem::path, bool>, AssetRole> roles_;  // by folder and welded
  std::map<std::filesystem::path, int> classes_;
  scene::CategoryFolders folders_;
};

}  // namespace simwright::workflows
