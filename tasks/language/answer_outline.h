#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tasks/language/answer_labels.h"

namespace simwright::tasks {

// An entry of an answer's outline: a labelled line, or a program.
struct OutlineEntry {
  LabelledLine line;
  std::string program;   // source of a reward function; empty: the entry is a line
  std::string function;  // its name; may be empty
  std::string title;     // a comment above the function; may be empty
};

// Returns the lines and programs of an answer in order. Programs are found by their functions, so
// code fences may be missing, left open, or enclose the whole answer. Functions of one fence are
// split into separate programs, and helper functions are added to the programs that call them.
// Blank lines and fences are left out. `answer` is text as PlainAnswer returns it.
std::vector<OutlineEntry> ReadOutline(std::string_view answer);

}  // namespace simwright::tasks
