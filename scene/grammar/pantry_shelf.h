#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A shelf of four boards, each with cans, bottles and fruit all over it. The shelf stands at the
// world's origin, open to -x.
Grammar PantryShelf(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
