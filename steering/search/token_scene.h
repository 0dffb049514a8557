#pragma once

#include <vector>

#include "scene/dataset/vocabulary.h"
#include "steering/rewards/judged_scene.h"

namespace simwright::steering {

// A scene as the tokens of a model, with the result of physics for each entry.
struct TokenScene {
  std::vector<float> tokens;  // (entries x TokenWidth)
  // One flag per entry, as in JudgedScene; empty entries have none set.
  std::vector<char> penetrating, unstable;

  // Returns a scene without objects.
  static TokenScene Empty(const scene::Vocabulary& vocabulary);

  // Returns true if the entry is padding: its most likely class is the empty one.
  bool IsEmpty(int entry, const scene::Vocabulary& vocabulary) const;
  // Returns the entries with an object, ascending: the objects of Judged() in their order.
  std::vector<int> ObjectEntries(const scene::Vocabulary& vocabulary) const;
  // Returns the objects with their flags.
  JudgedScene Judged(const scene::Vocabulary& vocabulary) const;

  // Writes an object into an entry, without flags, or padding for a null object.
  void Set(int entry, const scene::SceneObject* object, const scene::Vocabulary& vocabulary);
};

}  // namespace simwright::steering
