#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Returns the grammar of a breakfast table, 0.715 m by 1.4 m along y, at the world origin. Low
// clutter: settings for two and a crock of utensils; high: settings for six, and more shared
// dishes.
Grammar BreakfastTableLow(const CategorySizes& sizes = DefaultCategorySizes());
Grammar BreakfastTableHigh(const CategorySizes& sizes = DefaultCategorySizes());

}  // namespace simwright::scene
