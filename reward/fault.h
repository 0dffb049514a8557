#pragma once

#include <string>
#include <utility>

namespace simwright::reward {

// A position in the source; both numbers count from 1, columns in characters.
struct Position {
  int line = 1;
  int column = 1;
};

// The exception thrown while a program is parsed and compiled; CompileReward converts it to a
// core::Finding.
struct Fault {
  std::string code;  // stable short name; empty: caused by a fault that was already reported
  Position position;
  std::string sentence;
};

[[noreturn]] inline void Fail(std::string code, Position position, std::string sentence) {
  throw Fault{std::move(code), position, std::move(sentence)};
}

}  // namespace simwright::reward
