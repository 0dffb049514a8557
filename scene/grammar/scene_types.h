#pragma once

#include <string>
#include <vector>

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A kind of scene that a grammar is known for.
struct SceneType {
  std::string name;
  std::string what;  // in a sentence, for who chooses one
  int entries = 0;   // at most, of a scene, furniture among them
  Grammar (*make)(const SlotSizes&) = nullptr;
  std::vector<std::string> slots;  // all that it may derive, furniture among them; sorted
};

// All of them, sorted by name.
const std::vector<SceneType>& SceneTypes();

// Throws core::Error for an unknown name, with those there are.
const SceneType& SceneTypeNamed(const std::string& name);

}  // namespace simwright::scene
