#pragma once

#include "scene/grammar/grammar_builder.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A shelf of four boards with what a living room has: games in stacks, lamps, speakers, drinks, a
// book, toys, a plate with something on it. The shelf stands at the world's origin, open to -x.
Grammar LivingRoomShelf(const SlotSizes& sizes = DefaultSlotSizes());

// Adds that shelf as the symbol "shelf" to a grammar, with what is required of each of them and of
// the things on all of them.
void AddLivingRoomShelf(const SlotSizes& sizes, GrammarBuilder* builder);

}  // namespace simwright::scene
