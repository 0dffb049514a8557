#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {

// The contents of a round table for four: settings along its rim; teapots, dishes and stacks of
// steamers in its middle.
struct RoundTable {
  std::string category;           // category of the table
  std::array<double, 4> setting;  // weights of plate and cup, plate alone, cup alone, nothing
  double teapots = 0.0, dishes = 0.0, stacks = 0.0;  // probability of at least one
  std::vector<double> stack_counts;                  // if any: weights of 0, 1, ...
  bool chairs = false;                               // one per setting, on the floor
};

// Adds the symbol "table", welded, with its base on the plane where it is derived, and the objects
// on it; with chairs, also "table_and_chairs", the table and four chairs around it. Objects on one
// top are kept apart and inside its rim by resampling. The keep-out radii are published with the
// grammar.
void AddRoundTable(const RoundTable& table, const CategorySizes& sizes, GrammarBuilder* builder);

}  // namespace simwright::scene
