#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {

// Returns the grammar of a living-room shelf of four boards: stacks of games, lamps, speakers,
// drinks, a book, toys, a plate with food. The shelf is at the world origin and opens to -x.
Grammar LivingRoomShelf(const CategorySizes& sizes = DefaultCategorySizes());

// Adds this shelf to a grammar as the symbol "shelf", with the constraints on each shelf and on the
// objects of all shelves.
void AddLivingRoomShelf(const CategorySizes& sizes, GrammarBuilder* builder);

}  // namespace simwright::scene
