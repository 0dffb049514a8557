#pragma once

#include <string>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {

// Limits of the number of a scene's objects whose class is one of `classes`.
struct ClassLimit {
  std::vector<int> classes;  // of a vocabulary, without the empty class
  int least = 0, most = 0;   // 0 <= least <= most

  bool operator==(const ClassLimit&) const = default;
};

// Returns the limits that a prompt sets to the free classes of a vocabulary: as many of each name
// as it says; of all other free classes together none without "and others", at least one with it,
// and as many as a total count leaves; no more than the entries, one of which stays for furniture.
// For a known scene type (SceneTypes), exactly one of its main furniture and none of the furniture
// of other types: a network leaves out the table of a prompt with few objects, as unlike its data.
// Empty for the empty prompt. No class has two limits.
std::vector<ClassLimit> ClassLimitsOf(const Prompt& prompt, const Vocabulary& vocabulary);

// Returns true if the classes are 0 .. class_count - 2, each in one limit at most, and the bounds
// are in order.
bool AreValid(const std::vector<ClassLimit>& limits, int class_count, std::string* error);

}  // namespace simwright::scene
