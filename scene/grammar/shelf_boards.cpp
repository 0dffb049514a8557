#include "scene/grammar/shelf_boards.h"

#include <algorithm>

namespace simwright::scene {
namespace {

constexpr double kMiddle = 0.407;                         // m, over the foot, 17 mm of board below
constexpr double kBoards[] = {-0.39, -0.12, 0.14, 0.41};  // m, from the middle
constexpr double kWall = 0.015;                           // m, of the shelf's sides and back

}  // namespace

void AddShelf(const std::string& slot, const SlotSizes& sizes, const std::string& board,
              const std::string& top_board, GrammarBuilder* builder) {
  SizeOf(sizes, slot);  // that it is known
  std::vector<Child> boards;
  for (const double height : kBoards) {
    const bool top = height == kBoards[3];
    boards.push_back(Always(top ? top_board : board, Offset(0.0, 0.0, kMiddle + height)));
  }
  builder->And(Welded("shelf", slot), boards);
}

PoseRule AnywhereOnBoard(const SlotSizes& sizes, const std::string& shelf_slot,
                         const std::string& slot) {
  const double around = SizeOf(sizes, slot).half_size.norm();
  const Eigen::Vector2d room =
      (SizeOf(sizes, shelf_slot).half_size.array() - kWall - around).max(0.0);
  return UniformOnSurface({-room.x(), -room.y(), 0.0}, {room.x(), room.y(), 0.0}).FacingAnyWay();
}

}  // namespace simwright::scene
