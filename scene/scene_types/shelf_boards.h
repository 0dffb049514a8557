#pragma once

#include <array>
#include <string>

#include "scene/grammar/category_size.h"
#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {

// The shelf of both shelf scenes: 0.3 m deep, 0.6 m wide, its base at z = 0, with four boards whose
// upper sides support objects (Pfaff et al., appendix: -0.39, -0.12, 0.14 and 0.41 m from its
// middle). The published height, 0.783 m, is that of its sides, which stand on the lowest board and
// carry the uppermost.

// Returns the heights of the upper sides of the boards above the base, from the lowest board up, m.
const std::array<double, 4>& ShelfBoardHeights();

// Adds the symbol "shelf", welded, of the category `category`, whose three lower boards are the
// symbol `board` and whose uppermost is `top_board`; the caller defines both as surfaces.
void AddShelf(const std::string& category, const CategorySizes& sizes, const std::string& board,
              const std::string& top_board, GrammarBuilder* builder);

// Returns a pose rule that is uniform over a board of the shelf `shelf_slot`, with any yaw; an
// object of `category` keeps its larger half size from the walls. An object wider than the board
// stands in its middle.
PoseRule AnywhereOnBoard(const CategorySizes& sizes, const std::string& shelf_slot,
                         const std::string& category);

// Returns the rule for an object aligned with the board, or rotated by a right angle with `across`;
// `deviation` (rad) is the deviation of its yaw.
PoseRule AlignedOnBoard(const CategorySizes& sizes, const std::string& shelf_slot,
                        const std::string& category, bool across, double deviation);

// Returns a rule against the left wall as seen from the front (at +y), uniform along it.
PoseRule AtLeftWall(const CategorySizes& sizes, const std::string& shelf_slot,
                    const std::string& category);

}  // namespace simwright::scene
