#include "scene/scene_types/restaurant.h"

#include <numbers>

#include "scene/grammar/grammar_builder.h"
#include "scene/scene_types/living_room_shelf.h"
#include "scene/scene_types/round_table.h"

namespace simwright::scene {
namespace {

// Positions of tables and shelves, and their keep-out radii, m. Pfaff et al., Steerable Scene
// Generation, appendix, and its grammar (github.com/nepfaff/spatial_scene_grammars,
// dimsum_restaurant).
constexpr double kTablesFrom = -2.5, kTablesTo = 3.0, kAside = 3.0;
constexpr double kRestaurantWall = -4.75;
constexpr double kTableRadius = 0.8, kChairRadius = 0.35, kShelfRadius = 0.3;
constexpr int kDerivations = 5000;

struct RestaurantClutter {
  RoundTable table;
  std::vector<double> tables, shelves;  // weights of 0, 1, ...
  int tallest = 0;                      // smallest height of the tallest stack of steamers
  int most_entries = 0;                 // per scene, welded ones included
};

// Enforced by rejection: overlaps of tables and shelves are frequent when there are many, so that
// small numbers of them are sampled more often than their weights.
void RequireRestaurantRoom(GrammarBuilder* builder) {
  KeepOut apart;
  apart.name = "between tables, chairs and shelves";
  apart.bodies = {{"table", kTableRadius}, {"chair", kChairRadius}, {"shelf", kShelfRadius}};
  apart.exempt_within = "table_and_chairs";
  apart.decision = Decision::kReject;
  builder->Require(apart);
}

Grammar Restaurant(const std::string& name, const RestaurantClutter& clutter,
                   const CategorySizes& sizes) {
  GrammarBuilder builder(name, "room");
  const double thick = SizeOf(sizes, "floor").height;
  builder.And("room", {Always("floor", Offset(0.0, 0.0, -thick))});
  builder.And(Welded("floor", "floor"), {Always("ground", Offset(0.0, 0.0, thick))});
  builder.And(Surface("ground"), {Always("tables"), Always("shelves")});
  const PoseRule anywhere =
      UniformInWorld({kTablesFrom, -kAside, 0.0}, {kTablesTo, kAside, 0.0}).WithFreeYaw();
  builder.Repeat("tables", clutter.tables, Always("table_and_chairs", anywhere));
  // Shelves open to their -x, so they are rotated towards the room.
  const PoseRule at_wall =
      UniformInWorld({kRestaurantWall, -kAside, 0.0}, {kRestaurantWall, kAside, 0.0})
          .WithYaw(std::numbers::pi);
  builder.Repeat("shelves", clutter.shelves, Always("shelf", at_wall));
  AddRoundTable(clutter.table, sizes, &builder);
  AddLivingRoomShelf(sizes, &builder);
  RequireRestaurantRoom(&builder);
  builder.Require(TallestStackAtLeast("steamer", clutter.tallest));
  builder.Require(EntriesAtMost(clutter.most_entries));
  GrammarSampleOptions options;
  options.derivations = kDerivations;
  builder.Options(options);
  return builder.Build();
}

}  // namespace

Grammar RestaurantHigh(const CategorySizes& sizes) {
  RestaurantClutter clutter;
  clutter.table.category = "table_restaurant";
  clutter.table.setting = {0.5, 0.05, 0.05, 0.4};
  clutter.table.teapots = 0.9, clutter.table.dishes = 0.6, clutter.table.stacks = 0.9;
  clutter.table.stack_counts = GeometricWeights(0.2, 2, 4);
  clutter.table.chairs = true;
  clutter.tables = GeometricWeights(0.3, 3, 10);
  clutter.shelves = GeometricWeights(0.2, 0, 5);
  clutter.tallest = 3;
  clutter.most_entries = 125;
  return Restaurant("restaurant_high", clutter, sizes);
}

// Ours; published are only its mean of 35.1 objects and its largest number of entries, 107.
Grammar RestaurantLow(const CategorySizes& sizes) {
  RestaurantClutter clutter;
  clutter.table.category = "table_restaurant";
  clutter.table.setting = {0.25, 0.05, 0.05, 0.65};
  clutter.table.teapots = 0.7, clutter.table.dishes = 0.4, clutter.table.stacks = 0.6;
  clutter.table.stack_counts = GeometricWeights(0.6, 1, 3);
  clutter.table.chairs = true;
  clutter.tables = GeometricWeights(0.3, 2, 8);
  clutter.shelves = GeometricWeights(0.4, 0, 5);
  clutter.tallest = 2;
  clutter.most_entries = 107;
  return Restaurant("restaurant_low", clutter, sizes);
}

}  // namespace simwright::scene
