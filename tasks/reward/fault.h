#pragma once

#include <string>
#include <utility>

namespace simwright::tasks::reward {

// Where something stands in the source; both count from 1, columns in characters.
struct Position {
  int line = 1;
  int column = 1;
};

// Thrown while a program is read and compiled; becomes a core::Finding at the door.
struct Fault {
  std::string code;  // stable short name; empty: follows from a fault that was reported already
  Position position;
  std::string sentence;
};

[[noreturn]] inline void Fail(std::string code, Position position, std::string sentence) {
  throw Fault{std::move(code), position, std::move(sentence)};
}

}  // namespace simwright::tasks::reward
