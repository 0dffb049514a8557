#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Returns the grammar of a pantry shelf of four boards, each full of cans, bottles and fruit. The
// shelf is at the world origin and opens to -x.
Grammar PantryShelf(const CategorySizes& sizes = DefaultCategorySizes());

}  // namespace simwright::scene
