#include "viewer/contents/view_content.h"

#include <algorithm>
#include <vector>

#include "assets/asset_folder.h"
#include "assets/mesh_import.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/json.h"
#include "viewer/contents/asset_view.h"
#include "viewer/contents/rollout_view.h"
#include "viewer/contents/run_view.h"
#include "viewer/contents/scene_view.h"
#include "viewer/contents/task_view.h"

namespace simwright::viewer {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMaxJson = 64ull << 20;  // bytes

// Returns true if an entry of the folder satisfies the predicate.
template <typename Predicate>
bool AnyEntry(const fs::path& folder, const Predicate& predicate) {
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [&](const fs::directory_entry& entry) { return predicate(entry.path()); });
}

bool IsShard(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("part_") && name.ends_with(".h5");
}

std::vector<fs::path> ExportedScenes(const fs::path& folder) {
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && entry.path().filename().string().starts_with("scene_") &&
        fs::exists(entry.path() / "scene.json")) {
      scenes.push_back(entry.path());
    }
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

std::unique_ptr<Content> ReadJsonView(const fs::path& file) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMaxJson);
  if (document.json().is_object() && document.json().contains("tasks")) return ReadTasksView(file);
  return ReadScenesView({file}, file.filename().string());
}

std::unique_ptr<Content> ReadFileView(const fs::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".json") return ReadJsonView(file);
  if (ending == ".jsonl") return ReadRolloutView(file);
  if (ending == ".h5") return ReadDatasetView(file);
  if (ending == ".urdf" || assets::HasMeshExtension(file)) return ReadAssetView(file);
  throw core::Error("the viewer shows no file of this kind", file.string(),
                    "give a URDF, a mesh, tasks.json, poses (JSON or JSONL), or a folder");
}

std::unique_ptr<Content> ReadFolderView(const fs::path& folder) {
  if (assets::IsAssetFolder(folder)) return ReadAssetView(folder);
  if (IsPhotoRunFolder(folder)) return ReadPhotoRunView(folder);
  if (IsTrainingFolder(folder)) return ReadTrainingView(folder);
  if (AnyEntry(folder, IsShard)) return ReadDatasetView(folder);
  const std::vector<fs::path> scenes = ExportedScenes(folder);
  const std::string name = fs::absolute(folder).lexically_normal().filename().string();
  if (!scenes.empty()) return ReadScenesView(scenes, name);
  if (fs::exists(folder / "scene.json")) return ReadScenesView({folder}, name);
  if (fs::exists(folder / "tasks.json")) return ReadTasksView(folder / "tasks.json");
  if (AnyEntry(folder, assets::IsAssetFolder)) return ReadAssetsView(folder);
  if (assets::FilesBelow(folder, ".urdf").empty() && assets::FilesBelow(folder, ".xacro").empty()) {
    throw core::Error("holds nothing that the viewer shows", folder.string(),
                      "give a folder of assets, scenes, tasks, a training or a run, or one with a "
                      "URDF");
  }
  return ReadAssetView(folder);
}

bool ChangesByItself(const std::string& name) {
  return name == "training.csv" || name.ends_with(".pt") || name.ends_with(".svg") ||
         name.ends_with(".lock") || name.starts_with("events.out.") || name == ".lock" ||
         name == "trained.json";
}

}  // namespace

std::unique_ptr<Content> ReadViewContent(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw core::Error("there is no such file or folder", path.string());
  }
  return fs::is_directory(path) ? ReadFolderView(path) : ReadFileView(path);
}

ContentSource ViewSource(const fs::path& path) {
  return {[path] { return ReadViewContent(path); },
          [path] { return FingerprintOf(path.string(), ChangesByItself); }};
}

}  // namespace simwright::viewer
