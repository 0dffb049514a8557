#pragma once

#include "scene/grammar/grammar.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// A breakfast table, 0.715 m by 1.4 m along y, at the world's origin. Low clutter: settings for two
// and a crock of utensils; high: settings for six, and more that is shared.
Grammar BreakfastTableLow(const SlotSizes& sizes = DefaultSlotSizes());
Grammar BreakfastTableHigh(const SlotSizes& sizes = DefaultSlotSizes());

}  // namespace simwright::scene
