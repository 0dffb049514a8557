#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Returns the grammar of a round table with settings for four and shared dishes in its middle:
// teapots, serving dishes, stacks of steamers, the tallest of four or more. The table is at the
// world origin.
Grammar DimsumTable(const CategorySizes& sizes = DefaultCategorySizes());

}  // namespace simwright::scene
