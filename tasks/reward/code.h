#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tasks/reward/kernels.h"
#include "tasks/reward/reward_slot.h"

namespace simwright::tasks::reward {

// A column: register k of one chunk of environments, or as -1 - k number k for all of them.
using Column = int;

struct Instruction {
  Kernel kernel;
  Column result, a, b, c;
};

// One number of a slot into a register.
struct Load {
  int slot;
  int lane;
  Column column;
};

// Numbers of a slot that lie side by side, [N, 3], into three registers.
struct TripleLoad {
  int slot;
  Column columns[3];
};

// What is gathered over all environments while a stage runs.
struct Gathering {
  ScalarOperation operation;  // a sum, minimum, maximum, pick or flip
  Column operand;             // a register
  int environment;            // of a pick
  Column result;              // a number, or the spilled column's index for a flip
};

// One pass over all environments. The numbers for all are computed first.
struct Stage {
  std::vector<Load> uniform_loads;
  std::vector<Instruction> uniform;
  std::vector<Load> loads;
  std::vector<TripleLoad> triples;
  std::vector<Load> flips;  // slot: the spilled column
  std::vector<Instruction> body;
  std::vector<Gathering> gatherings;
};

struct ComponentCode {
  std::string name;
  std::vector<Column> columns;
};

// A compiled program.
struct Code {
  std::vector<RewardSlot> slots;
  std::vector<Stage> stages;
  int registers = 0;
  int numbers = 0;
  int spills = 0;
  int chunk = 0;                 // environments at a time
  std::vector<float> constants;  // of the first numbers
  Column batch_size = 0;         // a number where the program uses it, else 0
  Column reward = 0;
  bool has_success = false;
  Column success = 0;
  std::vector<ComponentCode> components;
  std::string entry;
  int operations = 0;  // of one environment
};

}  // namespace simwright::tasks::reward
