#include "scene/grammar/living_room_shelf.h"

#include "scene/grammar/grammar_builder.h"
#include "scene/grammar/shelf_boards.h"

namespace simwright::scene {
namespace {

constexpr char kShelf[] = "shelf_living_room";

// Probabilities and counts of Pfaff et al., Steerable Scene Generation, appendix; that a plate has
// one of its four fillings as often as another, and the deviations of stacks, are ours.
constexpr double kStackGoesOn = 0.3;
constexpr int kMostSmallGames = 5, kMostLargeGames = 3;  // in a stack
constexpr int kMostEntries = 23;                         // of a scene, the shelf among them
constexpr int kFewestObjects = 3;
constexpr double kAskew = 0.08;  // rad, of a game on the one below

// `symbol`, of `slot`, on which another of its kind stands with that probability.
void AddStack(const SlotSizes& sizes, const std::string& slot, GrammarBuilder* builder) {
  const PoseRule above = Offset(0.0, 0.0, SizeOf(sizes, slot).height).Turned(0.0, kAskew);
  builder->Or(Object(slot, slot),
              {With(kStackGoesOn, slot, above), With(1.0 - kStackGoesOn, kNothing)});
}

void AddCounted(const SlotSizes& sizes, const std::string& slot, double stop, int last,
                GrammarBuilder* builder) {
  builder->Repeat("some_" + slot, GeometricWeights(stop, 0, last),
                  Always(slot, AnywhereOnBoard(sizes, kShelf, slot)));
}

Child OnBoard(const SlotSizes& sizes, double probability, const std::string& slot) {
  return With(probability, slot, AnywhereOnBoard(sizes, kShelf, slot));
}

void AddPlate(const SlotSizes& sizes, GrammarBuilder* builder) {
  const PoseRule on_it = Offset(0.0, 0.0, SizeOf(sizes, "plate").rest_height).FacingAnyWay();
  builder->Or(Object("plate", "plate"), {With(1.0, "toast", on_it), With(1.0, "apple", on_it),
                                         With(1.0, "pear", on_it), With(1.0, kNothing)});
  for (const char* food : {"toast", "apple", "pear"}) builder->Leaf(Object(food, food));
}

void AddSettings(const SlotSizes& sizes, GrammarBuilder* builder) {
  AddCounted(sizes, "lamp", 0.8, 2, builder);
  AddCounted(sizes, "can", 0.7, 6, builder);
  AddCounted(sizes, "tea_bottle", 0.7, 6, builder);
  AddCounted(sizes, "console_game", 0.7, 3, builder);
  builder->Independent("top_setting",
                       {With(1.0, "some_lamp"), OnBoard(sizes, 0.2, "bowl"),
                        OnBoard(sizes, 0.3, "board_game_small"), OnBoard(sizes, 0.1, "speaker")});
  builder->Independent(
      "setting", {OnBoard(sizes, 0.3, "board_game_small"), OnBoard(sizes, 0.1, "speaker"),
                  With(1.0, "some_can"), With(1.0, "some_tea_bottle"), OnBoard(sizes, 0.2, "book"),
                  With(1.0, "some_console_game"), OnBoard(sizes, 0.2, "stacking_ring"),
                  OnBoard(sizes, 0.2, "toy_train"), OnBoard(sizes, 0.2, "plate")});
}

}  // namespace

Grammar LivingRoomShelf(const SlotSizes& sizes) {
  GrammarBuilder builder("living_room_shelf", "room");
  builder.And("room", {Always("shelf")});
  AddShelf(kShelf, sizes, "board", "top_board", &builder);
  const PoseRule middle = AnywhereOnBoard(sizes, kShelf, "board_game_large").Turned(0.0, kAskew);
  builder.Or(Surface("top_board"), {With(0.8, "top_setting"), With(0.1, "board_game_large", middle),
                                    With(0.1, kNothing)});
  builder.Or(Surface("board"),
             {With(0.7, "setting"), With(0.2, "board_game_large", middle), With(0.1, kNothing)});
  AddSettings(sizes, &builder);
  AddPlate(sizes, &builder);
  AddStack(sizes, "board_game_small", &builder);
  AddStack(sizes, "board_game_large", &builder);
  AddStack(sizes, "console_game", &builder);
  for (const char* slot :
       {"lamp", "bowl", "speaker", "can", "tea_bottle", "book", "stacking_ring", "toy_train"}) {
    builder.Leaf(Object(slot, slot));
  }
  builder.Require(TallestStackAtMost("board_game_small", kMostSmallGames));
  builder.Require(TallestStackAtMost("board_game_large", kMostLargeGames));
  builder.Require(ObjectsAtLeast(kFewestObjects));
  builder.Require(EntriesAtMost(kMostEntries));
  return builder.Build();
}

}  // namespace simwright::scene
