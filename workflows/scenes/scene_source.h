#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace simwright::workflows {

// An object of a scene that a command takes as its input.
struct SourceObject {
  std::string name;             // "cup_0", unique in the scene
  std::string slot;             // its category as the source names it; empty: by its asset
  std::filesystem::path asset;  // the asset folder
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  std::optional<bool> welded;  // nothing: as its category
};

struct SourceScene {
  std::string name;  // "scene_00003"
  std::vector<SourceObject> objects;
};

// The scenes of a source in any of our forms.
struct SceneSource {
  std::string type;  // the scene type; empty: not recorded
  std::vector<SourceScene> scenes;
  std::filesystem::path assets;  // its folder of asset folders; empty: none
};

// Reads scenes from a dataset (a folder of shards, or one), of which `scenes` picks some ("0,3-5";
// empty: the first), from a folder of `scene export` (scene_00003, with its scene.json), or from a
// JSON file of poses (docs/formats.md). Assets are looked for in `assets`, or where the source
// keeps them. Throws core::Error, naming the object, if the source is missing or damaged, has no
// scene or no object, a number of a pose is not finite, or an asset is missing or outside of the
// source's folder.
SceneSource ReadSceneSource(const std::filesystem::path& path, const std::string& scenes,
                            const std::filesystem::path& assets);

// Throws core::Error if writing the folder `output` would replace the source `path`: if it is the
// source, or a folder above it.
void RefuseOutputOver(const std::filesystem::path& path, const std::filesystem::path& output);

}  // namespace simwright::workflows
