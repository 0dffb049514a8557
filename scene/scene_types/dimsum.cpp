#include "scene/scene_types/dimsum.h"

#include "scene/grammar/grammar_builder.h"
#include "scene/scene_types/round_table.h"

namespace simwright::scene {

// Probabilities and counts are those of Pfaff et al., Steerable Scene Generation, appendix.
Grammar DimsumTable(const CategorySizes& sizes) {
  RoundTable table;
  table.category = "table_round";
  table.setting = {0.7, 0.025, 0.025, 0.2};
  table.teapots = 0.9, table.dishes = 0.6, table.stacks = 0.9;
  table.stack_counts = GeometricWeights(0.6, 1, 4);
  GrammarBuilder builder("dimsum", "room");
  builder.And("room", {Always("table")});
  AddRoundTable(table, sizes, &builder);
  builder.Require(TallestStackAtLeast("steamer", 4));
  builder.Require(StacksAtLeast("steamer", 3));
  builder.Require(EntriesAtMost(34));
  return builder.Build();
}

}  // namespace simwright::scene
