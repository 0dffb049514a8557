#pragma once

#include <string>
#include <vector>

#include "scene/grammar/grammar.h"

namespace simwright::scene {

// The width of a pose in a token: translation (3) and row-major rotation matrix (9).
inline constexpr int kPoseWidth = 12;

// The classes of learned scenes: class c is categories[c]; the last class is the empty
// class of the padding.
struct Vocabulary {
  std::string type;                     // scene type: "dimsum"
  int entries = 0;                      // most objects of a scene, furniture included
  std::vector<std::string> categories;  // sorted
  std::vector<bool> welded;             // (C) furniture, fixed in physics

  int ClassCount() const { return static_cast<int>(categories.size()) + 1; }
  int EmptyClass() const { return static_cast<int>(categories.size()); }
  // Returns the width of a token: pose and one-hot class.
  int TokenWidth() const { return kPoseWidth + ClassCount(); }
  // Returns the class of a category; -1 if it is not in the vocabulary.
  int ClassOf(const std::string& category) const;

  bool IsValid(std::string* error) const;
  bool operator==(const Vocabulary&) const = default;
};

// Returns the vocabulary of all categories of the grammar's symbols; its length is the grammar's
// EntriesAtMost. Throws core::Error for a grammar without that constraint, or with a category that
// is both welded and free.
Vocabulary VocabularyOf(const Grammar& grammar);

}  // namespace simwright::scene
