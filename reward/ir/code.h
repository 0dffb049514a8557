#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reward/reward_slot.h"
#include "reward/runtime/kernels.h"

namespace simwright::reward {

// The index of a column. k >= 0: register k of one chunk of environments. -1 - k: number k, which
// all environments share.
using Column = int;

struct Instruction {
  Kernel kernel;
  Column result, a, b, c;
};

// A load of one number of a slot into a register.
struct Load {
  int slot;
  int lane;
  Column column;
};

// A load of three adjacent numbers of a slot, [N, 3], into three registers.
struct TripleLoad {
  int slot;
  Column columns[3];
};

// A reduction, pick or flip over all environments, accumulated while a stage runs.
struct BatchReduction {
  ScalarOperation operation;  // sum, minimum, maximum, pick or flip
  Column operand;             // a register
  int environment;            // the environment to pick
  Column result;              // a number; for a flip, the index of the spilled column
};

// One pass over all environments. The uniform numbers are computed first.
struct Stage {
  std::vector<Load> uniform_loads;
  std::vector<Instruction> uniform;
  std::vector<Load> loads;
  std::vector<TripleLoad> triples;
  std::vector<Load> axis_flips;  // slot: the spilled column
  std::vector<Instruction> body;
  std::vector<BatchReduction> reductions;
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
  int register_spills = 0;
  int chunk = 0;                 // environments processed at a time
  std::vector<float> constants;  // values of the first numbers
  Column batch_size = 0;         // a number where the program uses it, else 0
  Column reward = 0;
  bool has_success = false;
  Column success = 0;
  std::vector<ComponentCode> components;
  std::string entry;
  int operations = 0;  // instructions per environment
};

}  // namespace simwright::reward
