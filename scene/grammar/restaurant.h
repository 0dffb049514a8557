#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A restaurant of 10 m by 10 m: round tables with chairs and dim sum, and living-room shelves along
// the wall at -x, open to the room. The floor's upper side is at z = 0; it, tables and shelves are
// welded, chairs are free. Low: with less on the tables, and fewer shelves.
Grammar RestaurantHigh(const SlotSizes& sizes = DefaultSlotSizes());
Grammar RestaurantLow(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
