#include "scene/export/placed_objects.h"

#include "core/error.h"

namespace simwright::scene {

std::vector<assets::WorldObject> WorldObjectsOf(const std::vector<SceneObject>& objects,
                                                const ExportedAssets& assets) {
  std::map<std::string, int> counts;
  std::vector<assets::WorldObject> instances;
  for (const SceneObject& object : objects) {
    const auto found = assets.find(object.category);
    if (found == assets.end()) {
      throw core::Error("this category of the scene has no asset", object.category);
    }
    assets::WorldObject instance;
    // Unique among all categories, because the text after the last underscore is the number.
    instance.name = object.category + "_" + std::to_string(counts[object.category]++);
    instance.asset = &found->second;
    instance.world_from_object = object.world_from_object;
    instance.welded = object.welded;
    instances.push_back(std::move(instance));
  }
  return instances;
}

}  // namespace simwright::scene
