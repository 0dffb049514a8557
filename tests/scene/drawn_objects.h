#pragma once

#include <string>

#include "scene/grammar/scene_draw.h"

namespace simwright::scene {

inline const DrawnObject& ParentOf(const SceneDraw& draw, const DrawnObject& object) {
  return draw.objects[static_cast<size_t>(object.parent)];
}

// Stands on a welded thing, not on another object.
inline bool IsBase(const SceneDraw& draw, const DrawnObject& object) {
  return object.parent >= 0 && !object.welded && ParentOf(draw, object).welded;
}

inline Eigen::Vector3d PlaceOf(const DrawnObject& object) {
  return object.world_from_object.translation();
}

// m, seen from above.
inline double Across(const DrawnObject& one, const DrawnObject& other) {
  return (PlaceOf(one) - PlaceOf(other)).head<2>().norm();
}

// What an object carries: the symbols of those that have it as parent, joined.
inline std::string CarriedBy(const SceneDraw& draw, size_t index) {
  std::string carried;
  for (const DrawnObject& object : draw.objects) {
    if (object.parent == static_cast<int>(index)) carried += object.symbol;
  }
  return carried;
}

}  // namespace simwright::scene
