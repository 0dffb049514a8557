#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Returns the grammar of a restaurant of 10 m by 10 m: round tables with chairs and dim sum, and
// living-room shelves along the wall at -x, open to the room. The top of the floor is at z = 0;
// floor, tables and shelves are welded, chairs are free. Low: fewer objects on the tables, and
// fewer shelves.
Grammar RestaurantHigh(const CategorySizes& sizes = DefaultCategorySizes());
Grammar RestaurantLow(const CategorySizes& sizes = DefaultCategorySizes());

}  // namespace simwright::scene
