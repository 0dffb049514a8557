#include "certificate/scene_bodies.h"

namespace simwright::certificate {

std::shared_ptr<const BodyModel> SceneBodies::At(const std::string& category) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<const BodyModel>& body = bodies_[category];
  if (!body) body = std::make_shared<BodyModel>(asset_set_.At(category).body);
  return body;
}

PlacedScene SceneBodies::SceneOf(const std::vector<scene::SceneObject>& objects,
                                 const std::vector<std::string>& names) const {
  PlacedScene scene;
  std::map<std::string, int> counts;
  for (size_t i = 0; i < objects.size(); ++i) {
    const scene::SceneObject& object = objects[i];
    const std::string numbered = object.category + "_" + std::to_string(counts[object.category]++);
    scene.bodies.push_back({i < names.size() ? names[i] : numbered, At(object.category),
                            object.world_from_object, object.welded});
  }
  return scene;
}

}  // namespace simwright::certificate
