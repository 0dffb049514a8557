#include "scene/feasibility/contact_groups.h"

#include "scene/feasibility/narrow_phase.h"

namespace simwright::scene {

std::vector<int> ContactGroups(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                               double touching) {
  ConvexBodies bodies;
  for (const SceneObject& object : objects) {
    bodies.Add(asset_set.At(object.category).parts, object.world_from_object, object.welded);
  }
  std::vector<NarrowPhasePair> near;
  bodies.Find(std::vector<Eigen::Vector3d>(objects.size(), Eigen::Vector3d::Zero()), touching,
              &near);
  std::vector<size_t> first(objects.size());  // the first object of each one's group
  for (size_t i = 0; i < first.size(); ++i) first[i] = i;
  for (bool grows = true; grows;) {
    grows = false;
    for (const NarrowPhasePair& pair : near) {
      const auto a = static_cast<size_t>(pair.a), b = static_cast<size_t>(pair.b);
      if (objects[a].welded || objects[b].welded || first[a] == first[b]) continue;
      first[a] = first[b] = std::min(first[a], first[b]);
      grows = true;
    }
  }
  std::vector<int> groups(objects.size(), -1);
  int count = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].welded) continue;
    groups[i] = first[i] == i ? count++ : groups[first[i]];
  }
  return groups;
}

}  // namespace simwright::scene
