#pragma once

#include <string>
#include <vector>

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// A scene type with its grammar.
struct SceneType {
  std::string name;
  std::string what;  // description in one sentence
  int entries = 0;   // most objects of a scene, furniture included
  Grammar (*make)(const CategorySizes&) = nullptr;
  std::vector<std::string> categories;  // all categories, furniture included; sorted
  std::string main_furniture;           // the category of which each scene has exactly one object
};

// Returns all scene types, sorted by name.
const std::vector<SceneType>& SceneTypes();

// Returns a scene type. Throws core::Error for an unknown name, listing the known ones.
const SceneType& SceneTypeNamed(const std::string& name);

}  // namespace simwright::scene
