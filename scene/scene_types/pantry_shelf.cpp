#include "scene/scene_types/pantry_shelf.h"

#include "scene/grammar/grammar_builder.h"
#include "scene/scene_types/shelf_boards.h"

namespace simwright::scene {
namespace {

// Counts and probabilities are those of Pfaff et al., Steerable Scene Generation, appendix.
constexpr double kStop = 0.6;     // stop probability of the geometric counts
constexpr int kMostOfAKind = 10;  // per board
constexpr double kFruitBowl = 0.2;
constexpr int kMostPantryEntries = 61;  // per scene, the shelf included
constexpr int kFewestPantryObjects = 3;
constexpr double kGoodsRadius = 0.01;  // m

const std::vector<std::string>& Goods() {
  static const std::vector<std::string> goods = {"can",     "tea_bottle", "apple",     "apple_2",
                                                 "apple_3", "apple_4",    "pear",      "pear_2",
                                                 "pear_3",  "avocado",    "avocado_2", "avocado_3"};
  return goods;
}

// Returns a constraint that keeps the objects of a board from sharing one position. Ours: without
// it the grammar gives more entries than the published scenes have, and the mechanism that removes
// them is not published.
KeepOut KeepGoodsApart() {
  KeepOut apart;
  apart.name = "between goods";
  for (const std::string& category : Goods()) apart.bodies.push_back({category, kGoodsRadius});
  apart.bodies.push_back({"bowl", kGoodsRadius});
  apart.decision = Decision::kReject;
  return apart;
}

}  // namespace

Grammar PantryShelf(const CategorySizes& sizes) {
  GrammarBuilder builder("pantry_shelf", "room");
  builder.And("room", {Always("shelf")});
  AddShelf("shelf_pantry", sizes, "board", "top_board", &builder);
  std::vector<Child> on_board;
  for (const std::string& category : Goods()) {
    on_board.push_back(Always("some_" + category));
    builder.Repeat("some_" + category, GeometricWeights(kStop, 0, kMostOfAKind),
                   Always(category, AnywhereOnBoard(sizes, "shelf_pantry", category)));
    builder.Leaf(Object(category, category));
  }
  builder.And(Surface("board"), on_board);
  on_board.push_back(Always("fruit_bowl"));
  builder.And(Surface("top_board"), on_board);
  builder.Independent("fruit_bowl",
                      {With(kFruitBowl, "bowl", AnywhereOnBoard(sizes, "shelf_pantry", "bowl"))});
  builder.Leaf(Object("bowl", "bowl"));
  builder.Require(KeepGoodsApart());
  builder.Require(ObjectsAtLeast(kFewestPantryObjects));
  builder.Require(EntriesAtMost(kMostPantryEntries));
  GrammarSampleOptions options;
  options.derivations = 5000;
  builder.Options(options);
  return builder.Build();
}

}  // namespace simwright::scene
