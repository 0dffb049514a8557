#pragma once

#include <string>

#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

inline const SceneObject& ParentOf(const SceneSample& sample, const SceneObject& object) {
  return sample.objects[static_cast<size_t>(object.parent)];
}

// Returns true if the object stands on a welded object, not on a free one.
inline bool IsBase(const SceneSample& sample, const SceneObject& object) {
  return object.parent >= 0 && !object.welded && ParentOf(sample, object).welded;
}

inline Eigen::Vector3d PlaceOf(const SceneObject& object) {
  return object.world_from_object.translation();
}

// Returns the horizontal distance, m.
inline double Across(const SceneObject& one, const SceneObject& other) {
  return (PlaceOf(one) - PlaceOf(other)).head<2>().norm();
}

// Returns the joined symbols of an object's children.
inline std::string CarriedBy(const SceneSample& sample, size_t index) {
  std::string carried;
  for (const SceneObject& object : sample.objects) {
    if (object.parent == static_cast<int>(index)) carried += object.symbol;
  }
  return carried;
}

}  // namespace simwright::scene
