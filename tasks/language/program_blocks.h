#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::tasks {

// True where `line` begins a function, or is its decorator.
bool BeginsFunction(std::string_view line);

// True for "import x" and "from x import y".
bool IsImport(std::string_view line);

// A reward function with all that it needs.
struct ProgramPiece {
  std::string title;     // a comment above it that reads like one; may be empty
  std::string function;  // its name; empty where the code defines none
  std::string text;      // ends in a line break
};

struct BlockPrograms {
  std::vector<ProgramPiece> programs;
  std::map<std::string, std::string> helpers;  // functions that others call, by name
};

// The reward functions of consecutive lines of code, in order. Functions that others of the block
// call are helpers and go with these. A block of one reward function is kept as it is.
BlockPrograms SplitProgramBlock(const std::vector<std::string>& lines);

// `program` with those of `helpers` in front that it calls and does not define.
std::string WithHelpers(const std::string& program,
                        const std::map<std::string, std::string>& helpers);

// The expression that `program` returns as success, as its source says it; empty where that cannot
// be told.
std::string SuccessOf(std::string_view program);

}  // namespace simwright::tasks
