#include "certificate/scene_bodies.h"

#include "manipulation/grasp_file.h"

namespace simwright::certificate {
namespace fs = std::filesystem;

std::vector<manipulation::Grasp> ProvedGraspsOfAsset(const fs::path& asset,
                                                     const ProvedGraspFiles& files) {
  if (!files.use || asset.empty()) return {};
  std::vector<fs::path> places = {asset / manipulation::kGraspFileName};
  if (!files.folder.empty()) {
    const fs::path name = asset.has_filename() ? asset.filename() : asset.parent_path().filename();
    places = {files.folder / name / manipulation::kGraspFileName,
              files.folder / (name.string() + ".json")};
  }
  for (const fs::path& place : places) {
    if (!fs::is_regular_file(place)) continue;
    manipulation::GraspSet set = manipulation::ReadGraspSet(place);
    if (set.gripper != files.gripper || !manipulation::GraspedLinks(set).empty()) return {};
    return std::move(set.grasps);
  }
  return {};
}

std::shared_ptr<const BodyModel> SceneBodies::At(const std::string& category) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<const BodyModel>& body = bodies_[category];
  if (!body) {
    const scene::SceneAsset& asset = asset_set_.At(category);
    body = std::make_shared<BodyModel>(asset.body, ProvedGraspsOfAsset(asset.folder, files_));
  }
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
