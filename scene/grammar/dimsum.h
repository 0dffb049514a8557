#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A round table with settings for four, and what is shared in its middle: teapots, dishes, stacks
// of steamers, the tallest of four or more. The table stands at the world's origin.
Grammar DimsumTable(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
