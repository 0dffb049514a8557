#pragma once

#include <string>
#include <vector>

#include "tasks/task.h"

namespace simwright::reward {

// A program with one fault planted in it, or rewritten without one.
struct Mutant {
  std::string kind;        // "sign of progress"
  tasks::Subtask subtask;  // the original with another program (for titles, another name)
};

// Returns variants with the faults found in published reward functions, and related ones, wherever
// `subtask`'s program (as the rules write it) offers a place for them. `other_way` is the program
// of the opposite joint task, for titles that name the wrong direction; empty: there is none.
std::vector<Mutant> PlantFaults(const tasks::Subtask& subtask, const std::string& other_way);

// Returns variants of the same reward in other forms, scales, spellings and names; all are valid.
std::vector<Mutant> RewriteSoundly(const tasks::Subtask& subtask);

}  // namespace simwright::reward
