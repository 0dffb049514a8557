#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::tasks {

// Returns true if `line` begins a function or is a function's decorator.
bool BeginsFunction(std::string_view line);

// Returns true for "import x" and "from x import y".
bool IsImport(std::string_view line);

// A reward function together with all definitions it needs.
struct ProgramPiece {
  std::string title;     // a comment above it that reads like a title; may be empty
  std::string function;  // its name; empty where the code defines none
  std::string text;      // ends in a line break
};

struct BlockPrograms {
  std::vector<ProgramPiece> programs;
  std::map<std::string, std::string> helpers;  // functions that others call, by name
};

// Splits consecutive lines of code into reward functions, in order. Functions that other functions
// of the block call are helpers and are included with their callers. A block with a single reward
// function is returned unchanged.
BlockPrograms SplitProgramBlock(const std::vector<std::string>& lines);

// Returns `program`, preceded by those of `helpers` that it calls and does not define.
std::string WithHelpers(const std::string& program,
                        const std::map<std::string, std::string>& helpers);

// Returns the source of the expression that `program` returns as success; empty where it cannot be
// determined.
std::string SuccessExpression(std::string_view program);

}  // namespace simwright::tasks
