#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "core/progress.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_assets.h"

namespace simwright::workflows {

// Returns the folder of the library's assets of a scene type. They are made once for each build of
// the program, by the first test that needs them; tests that run at the same time wait.
inline std::filesystem::path SharedSceneAssets(const std::string& type) {
  namespace fs = std::filesystem;
  const fs::path program = SIMWRIGHT_PROGRAM;
  const fs::path parent = program.parent_path().parent_path() / "test_assets";
  const auto built = fs::last_write_time(program).time_since_epoch();
  const std::string name =
      type + "_" +
      std::to_string(std::chrono::duration_cast<std::chrono::nanoseconds>(built).count());
  fs::create_directories(parent);
  for (const auto& entry : fs::directory_iterator(parent)) {
    const std::string other = entry.path().filename().string();
    if (other.starts_with(type + "_") && other != name) fs::remove_all(entry.path());
  }
  const scene::Grammar grammar = scene::SceneTypeNamed(type).make(scene::DefaultCategorySizes());
  core::Progress silent;
  GatherSceneAssets({scene::VocabularyOf(grammar).categories, {}, {}, parent / name}, &silent);
  return parent / name;
}

// Copies the assets of a scene type to where `simwright scene generate` keeps those of `output`.
inline void PlaceSceneAssets(const std::string& type, const std::filesystem::path& output) {
  std::filesystem::create_directories(output);
  std::filesystem::copy(SharedSceneAssets(type), output / "assets",
                        std::filesystem::copy_options::recursive);
}

}  // namespace simwright::workflows
