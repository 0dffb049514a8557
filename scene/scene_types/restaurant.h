#pragma once

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar.h"

namespace simwright::scene {

// Return the grammar of a restaurant of 10 m by 10 m: round tables with chairs and dim sum, and
// living-room shelves along the edge of the floor at -x, open to the room. The top of the floor is
// at z = 0; floor, tables and shelves are welded, chairs are free. On average, RestaurantLow has
// fewer tables, fewer objects on them and fewer shelves than RestaurantHigh.
Grammar RestaurantHigh(const CategorySizes& sizes = DefaultCategorySizes());
Grammar RestaurantLow(const CategorySizes& sizes = DefaultCategorySizes());

}  // namespace simwright::scene
