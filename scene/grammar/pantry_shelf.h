#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// Returns the grammar of a pantry shelf of four boards, each full of cans, bottles and fruit. The
// shelf is at the world origin and opens to -x.
Grammar PantryShelf(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
