#pragma once

#include <string>
#include <vector>

#include "tasks/task.h"

namespace simwright::tasks {

// A program with one fault planted in it, or rewritten without one.
struct Mutant {
  std::string kind;  // "sign of progress"
  Subtask subtask;   // as it was, with another program (and for titles another name)
};

// The faults found in published reward functions, and their near relations, wherever `subtask`'s
// program (as the rules write them) offers a place for them. `other_way`: the program of the
// opposite joint task, for titles that say the wrong way; empty: there is none.
std::vector<Mutant> PlantFaults(const Subtask& subtask, const std::string& other_way);

// The same reward in other shapes, scales, spellings and names: all sound.
std::vector<Mutant> RewriteSoundly(const Subtask& subtask);

}  // namespace simwright::tasks
