#pragma once

#include <string>
#include <vector>

#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Translation (3) and rotation matrix, row by row (9): how a pose lies in a token.
inline constexpr int kPoseWidth = 12;

// What the numbers of learned scenes stand for: class c is the slot slots[c], and one more, the
// last, is the empty class of what pads a scene to its length.
struct Vocabulary {
  std::string type;                // of scene: "dimsum"
  int entries = 0;                 // objects of a scene, furniture included, at most
  std::vector<std::string> slots;  // sorted
  std::vector<bool> welded;        // (C) furniture, fixed in physics

  int ClassCount() const { return static_cast<int>(slots.size()) + 1; }
  int EmptyClass() const { return static_cast<int>(slots.size()); }
  // Numbers of a token: pose and one-hot class.
  int TokenWidth() const { return kPoseWidth + ClassCount(); }
  // Class of a slot; -1 for one that is not here.
  int ClassOf(const std::string& slot) const;

  bool IsValid(std::string* error) const;
  bool operator==(const Vocabulary&) const = default;
};

// Every slot that the grammar's symbols stand for; its length is the grammar's EntriesAtMost.
// Throws core::Error for a grammar without that constraint, or where one slot is welded and free.
Vocabulary VocabularyOf(const Grammar& grammar);

}  // namespace simwright::scene
