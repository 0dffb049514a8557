#include "scene/scene_types/living_room_shelf.h"

#include <numbers>

#include "scene/scene_types/shelf_boards.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

constexpr char kShelf[] = "shelf_living_room";

// Probabilities, counts, radii and deviations are those of Pfaff et al., Steerable Scene
// Generation, appendix, and of its grammar (github.com/nepfaff/spatial_scene_grammars,
// tri_living_room_shelf).
constexpr double kAnotherOnTop = 0.3;
constexpr int kMostSmallGames = 5, kMostLargeGames = 3;  // per stack
constexpr int kMostShelfEntries = 23;                    // per scene, the shelf included
constexpr int kFewestShelfObjects = 3;
constexpr double kGameDeviation = 0.01;                              // m
constexpr double kSmallGame = 500.0;                                 // concentrations of yaws
constexpr double kLargeGameOnTop = 100.0, kLargeGameBelow = 1000.0;  //
constexpr double kLargeGameOnOther = 5000.0;                         //
constexpr double kQuarter = 0.5 * std::numbers::pi;

// Adds the symbol `category`, an object of the category of that name with another of its kind on
// top.
void AddStack(const std::string& category, const PoseRule& above, GrammarBuilder* builder) {
  builder->Or(Object(category, category),
              {With(kAnotherOnTop, category, above), With(1.0 - kAnotherOnTop, kNothing)});
}

void AddStacks(const CategorySizes& sizes, GrammarBuilder* builder) {
  const auto on = [&](const std::string& category, double deviation) {
    return GaussianOffset({0.0, 0.0, SizeOf(sizes, category).height}, {deviation, deviation, 0.0});
  };
  AddStack(
      "board_game_small",
      on("board_game_small", kGameDeviation).WithYaw(0.0, DeviationOfConcentration(kSmallGame)),
      builder);
  AddStack("board_game_large",
           on("board_game_large", 0.0).WithYaw(0.0, DeviationOfConcentration(kLargeGameOnOther)),
           builder);
  AddStack("console_game", on("console_game", kGameDeviation).WithFreeYaw(), builder);
}

void AddCounted(const CategorySizes& sizes, const std::string& category, double stop, int last,
                GrammarBuilder* builder) {
  builder->Repeat("some_" + category, GeometricWeights(stop, 0, last),
                  Always(category, AnywhereOnBoard(sizes, kShelf, category)));
}

Child OnBoard(const CategorySizes& sizes, double probability, const std::string& category) {
  return With(probability, category, AnywhereOnBoard(sizes, kShelf, category));
}

// Adds a plate with food: the same category as the plates of tables, but another symbol.
void AddPlate(const CategorySizes& sizes, GrammarBuilder* builder) {
  const auto on_it = [&](double deviation) {
    return GaussianOffset({0.0, 0.0, SizeOf(sizes, "plate").rest_height},
                          {deviation, deviation, 0.0})
        .WithFreeYaw();
  };
  builder->Or(Object("shelf_plate", "plate"),
              {With(1.0, "toast", on_it(0.015)), With(1.0, "apple", on_it(0.01)),
               With(1.0, "pear", on_it(0.001)), With(1.0, kNothing)});
  for (const char* food : {"toast", "apple", "pear"}) builder->Leaf(Object(food, food));
}

void AddBoardSettings(const CategorySizes& sizes, GrammarBuilder* builder) {
  AddCounted(sizes, "lamp", 0.8, 2, builder);
  AddCounted(sizes, "can", 0.7, 6, builder);
  AddCounted(sizes, "tea_bottle", 0.7, 6, builder);
  AddCounted(sizes, "console_game", 0.7, 3, builder);
  const double askew = DeviationOfConcentration(kSmallGame);
  builder->Or("small_games", {With(0.15, "board_game_small",
                                   AlignedOnBoard(sizes, kShelf, "board_game_small", false, askew)),
                              With(0.15, "board_game_small",
                                   AlignedOnBoard(sizes, kShelf, "board_game_small", true, askew)),
                              With(0.7, kNothing)});
  builder->Independent("top_setting", {With(1.0, "some_lamp"), OnBoard(sizes, 0.2, "bowl"),
                                       With(1.0, "small_games"), OnBoard(sizes, 0.1, "speaker")});
  builder->Independent(
      "board_setting",
      {With(1.0, "small_games"), OnBoard(sizes, 0.1, "speaker"), With(1.0, "some_can"),
       With(1.0, "some_tea_bottle"), With(0.2, "book", AtLeftWall(sizes, kShelf, "book")),
       With(1.0, "some_console_game"), OnBoard(sizes, 0.2, "stacking_ring"),
       OnBoard(sizes, 0.2, "toy_train"),
       With(0.2, "shelf_plate", AnywhereOnBoard(sizes, kShelf, "plate"))});
}

// Returns large games along the shelf, in either direction.
std::vector<Child> LargeGames(double weight, double concentration) {
  const PoseRule middle = GaussianOffset(Vector3d::Zero(), {kGameDeviation, kGameDeviation, 0.0});
  const double askew = DeviationOfConcentration(concentration);
  return {With(0.5 * weight, "board_game_large", middle.WithYaw(kQuarter, askew)),
          With(0.5 * weight, "board_game_large", middle.WithYaw(-kQuarter, askew))};
}

void AddBoards(GrammarBuilder* builder) {
  std::vector<Child> top = LargeGames(0.1, kLargeGameOnTop);
  top.push_back(With(0.8, "top_setting"));
  top.push_back(With(0.1, kNothing));
  builder->Or(Surface("top_board"), top);
  std::vector<Child> lower = LargeGames(0.2, kLargeGameBelow);
  lower.push_back(With(0.7, "board_setting"));
  lower.push_back(With(0.1, kNothing));
  builder->Or(Surface("board"), lower);
}

// On one board no object overlaps a plate or a stack of games, and no two stacks overlap: enforced
// by rejection, which favours boards with fewer objects. The published check also counts the games
// of one stack against each other, so that no stack of two small games ever passes it; ours do.
void RequireLivingRoomShelfRoom(GrammarBuilder* builder) {
  KeepOut apart;
  apart.name = "around stacks and plates on a board";
  apart.bodies = {{"shelf_plate", 0.11},
                  {"lamp", 0.02},
                  {"bowl", 0.1},
                  {"book", 0.07},
                  {"stacking_ring", 0.04},
                  {"toy_train", 0.045},
                  {"console_game", 0.07},
                  {"can", 0.0334},
                  {"tea_bottle", 0.0325},
                  {"speaker", 0.0875},
                  {"board_game_small", 0.132}};
  apart.against = {"shelf_plate", "console_game", "board_game_small"};
  apart.decision = Decision::kReject;
  builder->Require(apart);
}

}  // namespace

void AddLivingRoomShelf(const CategorySizes& sizes, GrammarBuilder* builder) {
  AddShelf(kShelf, sizes, "board", "top_board", builder);
  AddBoards(builder);
  AddBoardSettings(sizes, builder);
  AddPlate(sizes, builder);
  AddStacks(sizes, builder);
  for (const char* category :
       {"lamp", "bowl", "speaker", "can", "tea_bottle", "book", "stacking_ring", "toy_train"}) {
    builder->Leaf(Object(category, category));
  }
  builder->Require(TallestStackAtMost("board_game_small", kMostSmallGames));
  builder->Require(TallestStackAtMost("board_game_large", kMostLargeGames));
  builder->Require(ObjectsAtLeast(kFewestShelfObjects, "shelf"));
  RequireLivingRoomShelfRoom(builder);
}

Grammar LivingRoomShelf(const CategorySizes& sizes) {
  GrammarBuilder builder("living_room_shelf", "room");
  builder.And("room", {Always("shelf")});
  AddLivingRoomShelf(sizes, &builder);
  builder.Require(EntriesAtMost(kMostShelfEntries));
  return builder.Build();
}

}  // namespace simwright::scene
