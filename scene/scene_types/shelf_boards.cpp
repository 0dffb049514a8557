#include "scene/scene_types/shelf_boards.h"

#include <algorithm>
#include <numbers>

namespace simwright::scene {
namespace {

constexpr double kMiddle = 0.407;  // m above the base, with 17 mm of board below it
constexpr std::array<double, 4> kBoards = {kMiddle - 0.39, kMiddle - 0.12, kMiddle + 0.14,
                                           kMiddle + 0.41};
constexpr double kShelfBoardsWall = 0.015;  // m, thickness of the shelf's sides and back

// Returns a uniform rule over a board of that half size, with the margin `around` from its walls.
PoseRule Uniform(const Eigen::Vector2d& board, const Eigen::Vector2d& around) {
  const Eigen::Vector2d room = (board - around).array() - kShelfBoardsWall;
  const double x = std::max(0.0, room.x()), y = std::max(0.0, room.y());
  return UniformOnSurface({-x, -y, 0.0}, {x, y, 0.0});
}

}  // namespace

const std::array<double, 4>& ShelfBoardHeights() {
  return kBoards;
}

void AddShelf(const std::string& category, const CategorySizes& sizes, const std::string& board,
              const std::string& top_board, GrammarBuilder* builder) {
  SizeOf(sizes, category);  // throws for an unknown category
  std::vector<Child> boards;
  for (const double height : kBoards) {
    const bool top = height == kBoards.back();
    boards.push_back(Always(top ? top_board : board, Offset(0.0, 0.0, height)));
  }
  builder->And(Welded("shelf", category), boards);
}

PoseRule AnywhereOnBoard(const CategorySizes& sizes, const std::string& shelf_slot,
                         const std::string& category) {
  const double around = SizeOf(sizes, category).Radius();
  return Uniform(SizeOf(sizes, shelf_slot).half_size, {around, around}).WithFreeYaw();
}

PoseRule AlignedOnBoard(const CategorySizes& sizes, const std::string& shelf_slot,
                        const std::string& category, bool across, double deviation) {
  Eigen::Vector2d around = SizeOf(sizes, category).half_size;
  if (across) around = around.reverse().eval();
  return Uniform(SizeOf(sizes, shelf_slot).half_size, around)
      .WithYaw(across ? 0.5 * std::numbers::pi : 0.0, deviation);
}

PoseRule AtLeftWall(const CategorySizes& sizes, const std::string& shelf_slot,
                    const std::string& category) {
  const Eigen::Vector2d& board = SizeOf(sizes, shelf_slot).half_size;
  const Eigen::Vector2d& around = SizeOf(sizes, category).half_size;
  const double x = std::max(0.0, board.x() - kShelfBoardsWall - around.x());
  const double y = std::max(0.0, board.y() - kShelfBoardsWall - around.y());
  return UniformOnSurface({-x, y, 0.0}, {x, y, 0.0});
}

}  // namespace simwright::scene
