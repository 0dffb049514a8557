#include "workflows/scenes/start_scene.h"

#include "core/error.h"
#include "scene/dataset/tokens.h"
#include "workflows/scenes/scene_source.h"
#include "workflows/scenes/source_assets.h"

namespace simwright::workflows {

StartScene ReadStartScene(const std::filesystem::path& path, const std::string& index,
                          const std::filesystem::path& assets,
                          const scene::Vocabulary& vocabulary) {
  const SceneSource source = ReadSceneSource(path, index, assets);
  if (source.scenes.size() != 1) {
    throw core::Error("a search starts from one scene", path.string(), "name one: --scene 3");
  }
  const SourceScene& given = source.scenes.front();
  if (given.objects.size() > static_cast<size_t>(vocabulary.entries)) {
    throw core::Error("the scene has " + std::to_string(given.objects.size()) +
                          " objects, but the model takes at most " +
                          std::to_string(vocabulary.entries),
                      path.string());
  }
  SourceAssets roles(&vocabulary);
  std::vector<scene::SceneObject> objects;
  for (const SourceObject& one : given.objects) {
    const AssetRole& role = roles.RoleOf(one);
    if (role.model_class < 0) {
      throw core::Error("the model does not know the asset of " + one.name, path.string(),
                        "choose the model of its scene type, or remove the object");
    }
    if (vocabulary.ClassOf(role.key) < 0) {
      throw core::Error("the scene has two different assets for the category of " + one.name,
                        path.string(), "a search takes one asset per category");
    }
    scene::SceneObject object;
    object.category = role.key;
    object.world_from_object = one.world_from_object;
    object.welded = role.welded;
    objects.push_back(std::move(object));
  }
  StartScene start{steering::TokenScene::Empty(vocabulary), roles.folders(), source.assets};
  EncodeScene(objects, vocabulary, start.scene.tokens.data());
  return start;
}

}  // namespace simwright::workflows
