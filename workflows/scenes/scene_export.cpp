#include "workflows/scenes/scene_export.h"

#include <algorithm>
#include <cstdio>

#include "assets/asset_folder.h"
#include "assets/usd_asset.h"
#include "assets/usd_world.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "scene/export/placed_objects.h"
#include "scene/export/scene_files.h"
#include "scene/export/scene_picture.h"
#include "workflows/scenes/dataset_scenes.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

std::string FolderName(int scene) {
  char name[32];
  std::snprintf(name, sizeof name, "scene_%05d", scene);
  return name;
}

std::set<std::string> FormatsOf(const SceneExportRequest& request) {
  std::set<std::string> formats = request.formats;
  const std::vector<std::string>& known = SceneFormats();
  if (formats.erase("all") > 0) formats.insert(known.begin(), known.end());
  for (const std::string& format : formats) {
    if (std::find(known.begin(), known.end(), format) == known.end()) {
      throw core::Error("there is no such world format", format,
                        "urdf, sdf, mjcf, drake, usd, all");
    }
  }
  if (formats.empty()) throw core::Error("no format is given", "--format");
  if (request.check) formats.insert("mjcf");
  return formats;
}

std::vector<int> ScenesOf(const SceneExportRequest& request, int count) {
  if (!request.scenes.empty()) return ParseSceneIndices(request.scenes, count);
  const int wanted = request.count < 0 ? count : request.count;
  if (wanted < 1) throw core::Error("at least 1 scene must be exported", "--count");
  if (wanted > count) {
    throw core::Error(
        "there are " + std::to_string(count) + " scenes, not " + std::to_string(wanted), "--count");
  }
  std::vector<int> scenes(static_cast<size_t>(wanted));
  for (int i = 0; i < wanted; ++i) scenes[static_cast<size_t>(i)] = i;
  return scenes;
}

// Returns the output folder's name as a Drake package name.
std::string PackageOf(const fs::path& output) {
  const fs::path whole = fs::absolute(output).lexically_normal();
  const fs::path& named = whole.has_filename() ? whole : whole.parent_path();
  return assets::FileSafeName(named.filename().string());
}

// The requested scenes and their objects.
class Export {
 public:
  Export(const SceneExportRequest& request, core::Progress* progress)
      : formats_(FormatsOf(request)),
        dataset_(request.dataset),
        scenes_(ScenesOf(request, dataset_.SceneCount())),
        package_(PackageOf(request.output)),
        progress_(progress) {
    std::set<std::string> categories;
    for (const int scene : scenes_) {
      objects_.push_back(SceneAt(dataset_, scene));
      for (const scene::SceneObject& object : objects_.back()) categories.insert(object.category);
    }
    folders_ = FoldersOfCategories(request.dataset, request.assets, categories);
    asset_set_ = scene::ReadAssetSet(folders_);
    RequireSameAssets(dataset_, asset_set_, categories);
    for (const auto& [category, folder] : folders_) {
      assets_[category] = {category, "../assets/" + category + "/", assets::ReadAsset(folder)};
    }
  }

  SceneExportReport Write(const fs::path& folder) const {
    SceneExportReport report;
    fs::create_directories(folder / "assets");
    for (const auto& [category, from] : folders_) {
      core::CheckCancelled();
      fs::copy(from, folder / "assets" / category, fs::copy_options::recursive);
      if (formats_.count("usd") > 0) WriteAssetUsd(category, folder / "assets" / category);
    }
    if (formats_.count("drake") > 0) {
      core::WriteFile(folder / "package.xml", scene::PackageXml(package_));
      core::WriteFile(folder / "ground.sdf", assets::GroundSdf());
    }
    report.assets = static_cast<int>(folders_.size());
    progress_->Stage("scenes", static_cast<int>(scenes_.size()));
    for (size_t i = 0; i < scenes_.size(); ++i) {
      core::CheckCancelled();
      report.scenes.push_back(FolderName(scenes_[i]));
      WriteScene(i, folder / report.scenes.back());
      progress_->Advance();
    }
    return report;
  }

  std::vector<SceneStability> Check(const fs::path& folder) const {
    std::vector<SceneStability> checks(scenes_.size());
    progress_->Stage("watching", static_cast<int>(scenes_.size()));
    core::ParallelFor(static_cast<int>(scenes_.size()), [&](int index) {
      core::CheckCancelled();
      const auto i = static_cast<size_t>(index);
      std::vector<std::string> names;
      for (const assets::WorldObject& instance : WorldObjectsOf(objects_[i], assets_)) {
        names.push_back(instance.name);
      }
      const std::string name = FolderName(scenes_[i]);
      checks[i] = CheckSceneStability(folder / name / "scene.xml", objects_[i], names, asset_set_);
      checks[i].name = name;
      progress_->Advance();
    });
    return checks;
  }

 private:
  // Writes the layer that the scenes refer to.
  void WriteAssetUsd(const std::string& category, const fs::path& folder) const {
    const assets::Asset& asset = assets_.at(category).asset;
    const assets::PbrLook look = assets::ReadPbrLook(folder);
    assets::WriteUsd(assets::UsdOf(asset, look), folder, category + ".usda");
  }

  void WriteScene(size_t index, const fs::path& folder) const {
    scene::ExportedScene exported;
    exported.name = FolderName(scenes_[index]);
    exported.type = dataset_.vocabulary().type;
    exported.index = scenes_[index];
    exported.objects = WorldObjectsOf(objects_[index], assets_);
    fs::create_directories(folder);
    core::WriteFile(folder / "scene.json", SceneJson(exported));
    if (formats_.count("sdf") > 0) {
      core::WriteFile(folder / "world.sdf", WorldSdf(exported.name, exported.objects));
      core::WriteFile(folder / "gazebo.sdf",
                      WorldSdf(exported.name, exported.objects, assets::SdfReader::kGazebo));
    }
    if (formats_.count("mjcf") > 0) {
      core::WriteFile(folder / "scene.xml", WorldMjcf(exported.name, exported.objects));
    }
    if (formats_.count("drake") > 0) {
      core::WriteFile(folder / "scene.dmd.yaml", DrakeDirectives(exported, package_));
    }
    if (formats_.count("usd") > 0) {
      core::WriteFile(folder / "scene.usda", WorldUsd(exported.name, exported.objects));
    }
  }

  std::set<std::string> formats_;
  scene::SceneDataset dataset_;
  std::vector<int> scenes_;
  std::string package_;
  core::Progress* progress_;
  std::vector<std::vector<scene::SceneObject>> objects_;  // by scene
  scene::CategoryFolders folders_;
  scene::AssetSet asset_set_;
  scene::ExportedAssets assets_;
};

}  // namespace

const std::vector<std::string>& SceneFormats() {
  static const std::vector<std::string> formats = {"urdf", "sdf", "mjcf", "drake", "usd"};
  return formats;
}

SceneExportReport ExportScenes(const SceneExportRequest& request, core::Progress* progress) {
  const Export scenes(request, progress);
  core::StagedFolder staged(request.output, request.force);
  SceneExportReport report = scenes.Write(staged.staging());
  report.output = request.output;
  if (request.check) {
    report.checks = scenes.Check(staged.staging());
    core::WriteFile(staged.staging() / "stillness.json", StabilityJson(report));
  }
  progress->Finish();
  staged.Commit();
  return report;
}

core::Image SceneView(const fs::path& dataset, const fs::path& assets, int scene, int size) {
  if (size < 16 || size > 4096) throw core::Error("a picture has 16 to 4096 pixels", "--size");
  const scene::SceneDataset scenes(dataset);
  const std::vector<scene::SceneObject> objects = SceneAt(scenes, scene);
  std::set<std::string> categories;
  for (const scene::SceneObject& object : objects) categories.insert(object.category);
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(FoldersOfCategories(dataset, assets, categories));
  return core::ContactSheet(
      {RenderFromAbove(objects, asset_set, size), RenderFromSide(objects, asset_set, size)}, 2);
}

}  // namespace simwright::workflows
