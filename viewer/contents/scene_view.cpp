#include "viewer/contents/scene_view.h"

#include <cstdio>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "scene/dataset/scene_dataset.h"
#include "viewer/contents/asset_view.h"
#include "viewer/contents/drop_replay.h"
#include "viewer/model_document.h"
#include "workflows/scenes/dataset_scenes.h"
#include "workflows/scenes/scene_source.h"

namespace simwright::viewer {
namespace fs = std::filesystem;
namespace {

using core::OrderedJson;

// HDF5 and the shards are not thread-safe, whichever version of a dataset reads.
std::mutex& DatasetMutex() {
  static std::mutex mutex;
  return mutex;
}

// An asset of scenes: its model in the manifest and its body.
struct ShownAsset {
  int model = 0;
  sim::RigidBody body;
};

// An object of a scene.
struct ShownObject {
  std::string name, asset;  // `asset`: key of the assets
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
  bool welded = false;
};

class ScenesContent : public Content {
 public:
  ScenesContent(Document document, std::map<std::string, ShownAsset> assets)
      : Content(std::move(document)), assets_(std::move(assets)) {}

  virtual std::vector<ShownObject> Objects(int world) = 0;

  OrderedJson Bodies(int world) override {
    std::vector<WorldBody> bodies;
    for (const ShownObject& object : Objects(world)) {
      bodies.push_back(
          {object.name, assets_.at(object.asset).model, object.world_from_object, object.welded});
    }
    return BodiesJson(bodies);
  }

  Timeline Replay(int world) override {
    std::vector<DroppedBody> bodies;
    for (const ShownObject& object : Objects(world)) {
      bodies.push_back(
          {object.name, &assets_.at(object.asset).body, object.world_from_object, object.welded});
    }
    return DropReplay(bodies);
  }

 private:
  std::map<std::string, ShownAsset> assets_;
};

class DatasetContent : public ScenesContent {
 public:
  DatasetContent(Document document, std::map<std::string, ShownAsset> assets,
                 scene::SceneDataset dataset)
      : ScenesContent(std::move(document), std::move(assets)), dataset_(std::move(dataset)) {}

  std::vector<ShownObject> Objects(int world) override {
    std::vector<scene::SceneObject> objects;
    {
      const std::lock_guard lock(DatasetMutex());
      objects = workflows::SceneAt(dataset_, world);
    }
    std::map<std::string, int> counts;
    std::vector<ShownObject> shown;
    for (const scene::SceneObject& object : objects) {
      shown.push_back({object.category + "_" + std::to_string(counts[object.category]++),
                       object.category, object.world_from_object, object.welded});
    }
    return shown;
  }

 private:
  scene::SceneDataset dataset_;
};

class SourceContent : public ScenesContent {
 public:
  SourceContent(Document document, std::map<std::string, ShownAsset> assets,
                std::vector<std::vector<ShownObject>> scenes)
      : ScenesContent(std::move(document), std::move(assets)), scenes_(std::move(scenes)) {}

  std::vector<ShownObject> Objects(int world) override {
    return scenes_[static_cast<std::size_t>(world)];
  }

 private:
  std::vector<std::vector<ShownObject>> scenes_;
};

ShownAsset ShowAsset(const fs::path& folder, DocumentBuilder* builder) {
  const assets::Asset asset = assets::ReadAsset(folder);
  return {builder->AddModel(ModelOf(asset, builder)), sim::BodyFromAsset(asset)};
}

std::string EntryName(int scene) {
  char name[32];
  std::snprintf(name, sizeof name, "scene %05d", scene);
  return name;
}

void AddDatasetWorlds(const scene::SceneDataset& dataset, DocumentBuilder* builder) {
  int scene = 0;
  for (const scene::SceneShardFile& part : dataset.parts()) {
    // Some shards have no prompts.
    const std::vector<std::string> prompts = part.Prompts(0, part.SceneCount());
    for (int i = 0; i < part.SceneCount(); ++i) {
      OrderedJson world = {{"name", EntryName(scene++)}, {"replay", DropOffer()}};
      if (!prompts.empty()) world["description"] = prompts[static_cast<std::size_t>(i)];
      builder->AddWorld(std::move(world));
    }
  }
}

}  // namespace

std::unique_ptr<Content> ReadDatasetView(const fs::path& path) {
  const std::lock_guard lock(DatasetMutex());
  scene::SceneDataset dataset(path);
  if (dataset.SceneCount() == 0) throw core::Error("the dataset has no scenes", path.string());
  const scene::Vocabulary& vocabulary = dataset.vocabulary();
  DocumentBuilder builder(
      "scenes", vocabulary.type + ": " + std::to_string(dataset.SceneCount()) + " scenes");
  std::map<std::string, ShownAsset> assets;
  const std::set<std::string> categories(vocabulary.categories.begin(),
                                         vocabulary.categories.end());
  for (const auto& [category, folder] : workflows::FoldersOfCategories(path, {}, categories)) {
    assets.emplace(category, ShowAsset(folder, &builder));
  }
  AddDatasetWorlds(dataset, &builder);
  return std::make_unique<DatasetContent>(builder.Take(), std::move(assets), std::move(dataset));
}

std::unique_ptr<Content> ReadScenesView(const std::vector<fs::path>& paths,
                                        const std::string& title) {
  DocumentBuilder builder("scenes", title);
  std::map<std::string, ShownAsset> assets;
  std::vector<std::vector<ShownObject>> scenes;
  for (const fs::path& path : paths) {
    for (const workflows::SourceScene& scene : workflows::ReadSceneSource(path, "", {}).scenes) {
      std::vector<ShownObject>& objects = scenes.emplace_back();
      for (const workflows::SourceObject& object : scene.objects) {
        const std::string key = object.asset.string();
        if (!assets.contains(key)) assets.emplace(key, ShowAsset(object.asset, &builder));
        objects.push_back(
            {object.name, key, object.world_from_object, object.welded.value_or(false)});
      }
      builder.AddWorld({{"name", scene.name}, {"replay", DropOffer()}});
    }
  }
  return std::make_unique<SourceContent>(builder.Take(), std::move(assets), std::move(scenes));
}

}  // namespace simwright::viewer
