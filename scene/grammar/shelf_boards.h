#pragma once

#include <string>

#include "scene/grammar/grammar_builder.h"
#include "scene/grammar/slot_size.h"

namespace simwright::scene {

// The shelf of both shelf scenes: 0.3 m deep, 0.6 m wide, its foot at z = 0, with four boards on
// whose upper sides things stand (Pfaff et al., appendix: -0.39, -0.12, 0.14 and 0.41 m from its
// middle). The published height, 0.783 m, is that of its sides, which stand on the lowest board and
// carry the uppermost.

// Adds the symbol "shelf", welded, of `slot`, whose three lower boards are the symbol `board` and
// whose uppermost is `top_board`: both to be defined as surfaces.
void AddShelf(const std::string& slot, const SlotSizes& sizes, const std::string& board,
              const std::string& top_board, GrammarBuilder* builder);

// Uniform over a board of the shelf `shelf_slot`, so that a thing of `slot` stands off its walls by
// its larger half size; turned anyhow. What is wider than the board stands in its middle.
PoseRule AnywhereOnBoard(const SlotSizes& sizes, const std::string& shelf_slot,
                         const std::string& slot);

// The same for a thing that stands along the board, or with `across` turned by a right angle, its
// yaw off that by `deviation` (rad).
PoseRule SquarelyOnBoard(const SlotSizes& sizes, const std::string& shelf_slot,
                         const std::string& slot, bool across, double deviation);

// Against the wall that is left as one looks in, at y, uniform along it.
PoseRule AtLeftWall(const SlotSizes& sizes, const std::string& shelf_slot, const std::string& slot);

}  // namespace simwright::scene
