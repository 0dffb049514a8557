#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/grammar/grammar_builder.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// What stands on a round table for four: settings at its rim, in its middle teapots, dishes and
// stacks of steamers.
struct RoundTable {
  std::string slot;               // of the table itself
  std::array<double, 4> setting;  // weights of plate and cup, plate alone, cup alone, nothing
  double teapots = 0.0, dishes = 0.0, stacks = 0.0;  // probability that there are any
  std::vector<double> stack_counts;                  // where there are: weights of 0, 1, ...
  bool chairs = false;                               // one a setting, on the floor
};

// Adds the symbol "table", welded, its foot on the plane that it is derived on, and all that stands
// on it; where there are chairs, also "table_and_chairs", the table and four chairs about it;
// what stands on one top is kept apart and inside its rim by drawing it anew. The radius of what
// has to be kept free about each is published with the grammar.
void AddRoundTable(const RoundTable& table, const SlotSizes& sizes, GrammarBuilder* builder);

}  // namespace simwright::scene
