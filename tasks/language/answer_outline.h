#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tasks/language/answer_labels.h"

namespace simwright::tasks {

// A piece of an answer: a line with its label, or a program.
struct OutlineEntry {
  LabelledLine line;
  std::string program;   // source of a reward function; empty: a line
  std::string function;  // its name; may be empty
  std::string title;     // a comment above it; may be empty
};

// An answer's lines and programs in order. Programs are found by their functions, so that code
// fences may be missing, left open, or hold the whole answer; functions of one fence are taken
// apart, and those that others call are added to these. Blank lines and fences are left out.
// `answer` as PlainAnswer gives it.
std::vector<OutlineEntry> OutlineOf(std::string_view answer);

}  // namespace simwright::tasks
