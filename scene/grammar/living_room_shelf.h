#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A shelf of four boards with what a living room has: games in stacks, lamps, speakers, drinks, a
// book, toys, a plate with something on it. The shelf stands at the world's origin, open to -x.
Grammar LivingRoomShelf(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
