#include "scene/scene_types/round_table.h"

#include <cmath>
#include <numbers>

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Probabilities, radii, counts and variances are those of Pfaff et al., Steerable Scene Generation,
// appendix, and its grammars (github.com/nepfaff/spatial_scene_grammars, dimsum_restaurant), after
// Izatt and Tedrake's dimsum tables.
constexpr double kSettingRadius = 0.5;           // m, of the plates' centres around the table's
constexpr double kCupInwards = 0.25;             // m, from the plate to the table's middle
constexpr double kChairDistance = 1.1;           // m
constexpr double kRoundTableRimMargin = 0.15;    // m
constexpr double kOneStops = 0.5;                // stop probability of one or two teapots or dishes
const double kPlateDeviation = std::sqrt(1e-3);  // m, along and across
const double kCupAcross = std::sqrt(5e-3);
const double kTeapotDeviation = std::sqrt(0.01);
const double kDishDeviation = std::sqrt(0.02);
const double kStackDeviation = std::sqrt(0.025);
const double kChairAlong = std::sqrt(5e-3), kChairAcross = std::sqrt(0.03);
constexpr double kChairConcentration = 50.0;  // of a chair's yaw

PoseRule AboutMiddle(double deviation) {
  return GaussianOffset(Vector3d::Zero(), {deviation, deviation, 0.0}).WithFreeYaw();
}

void AddRoundTableSettings(const RoundTable& table, GrammarBuilder* builder) {
  std::vector<Child> places;
  for (int i = 0; i < 4; ++i) {
    // The x axis of a setting points to the table's middle.
    const double angle = 0.5 * std::numbers::pi * i;
    places.push_back(Always(
        "setting", Offset(-kSettingRadius * std::cos(angle), -kSettingRadius * std::sin(angle))
                       .WithYaw(angle)));
  }
  builder->And("settings", places);
  const Child a_plate = Always("plate", AboutMiddle(kPlateDeviation));
  const Child a_cup = Always(
      "cup",
      GaussianOffset({kCupInwards, 0.0, 0.0}, {kPlateDeviation, kCupAcross, 0.0}).WithFreeYaw());
  builder->Or("setting",
              {With(table.setting[0], "plate_and_cup"), With(table.setting[1], "plate_alone"),
               With(table.setting[2], "cup_alone"), With(table.setting[3], kNothing)});
  builder->And("plate_and_cup", {a_plate, a_cup});
  builder->And("plate_alone", {a_plate});
  builder->And("cup_alone", {a_cup});
  builder->Leaf(Object("plate", "plate"));
  builder->Leaf(Object("cup", "cup"));
}

void AddMiddle(const RoundTable& table, const CategorySizes& sizes, GrammarBuilder* builder) {
  builder->Independent("middle", {With(table.teapots, "teapots"), With(table.dishes, "dishes"),
                                  With(table.stacks, "stacks")});
  const std::vector<double> one_or_two = GeometricWeights(kOneStops, 1, 2);
  builder->Repeat("teapots", one_or_two, Always("teapot", AboutMiddle(kTeapotDeviation)));
  builder->Repeat("dishes", one_or_two, Always("serving_dish", AboutMiddle(kDishDeviation)));
  builder->Repeat("stacks", table.stack_counts, Always("steamer", AboutMiddle(kStackDeviation)));
  builder->Leaf(Object("teapot", "teapot"));
  builder->Leaf(Object("serving_dish", "serving_dish"));
  const PoseRule on_it = Offset(0.0, 0.0, SizeOf(sizes, "steamer").height).WithFreeYaw();
  builder->Or(
      Object("steamer", "steamer"),
      {With(0.25, "steamer", on_it), With(0.4, "steamer_lid", on_it), With(0.35, kNothing)});
  builder->Leaf(Object("steamer_lid", "steamer_lid"));
}

void AddChairs(GrammarBuilder* builder) {
  const double askew = DeviationOfConcentration(kChairConcentration);
  std::vector<Child> places;
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.5 * std::numbers::pi * i;
    places.push_back(Always("chair_place", SamePose().WithYaw(angle)));
  }
  places.push_back(Always("table"));
  builder->And("table_and_chairs", places);
  // The x axis of a chair points in the viewing direction of a sitting person.
  builder->And(
      "chair_place",
      {Always("chair", GaussianOffset({-kChairDistance, 0.0, 0.0}, {kChairAlong, kChairAcross, 0.0})
                           .WithYaw(0.0, askew))});
  builder->Leaf(Object("chair", "chair"));
}

void RequireInside(const std::vector<std::string>& symbols, double radius, double margin,
                   GrammarBuilder* builder) {
  InsideRim rim;
  rim.surface = "tabletop";
  rim.symbols = symbols;
  rim.round = true;
  rim.half_x = radius;
  rim.margin = margin;
  builder->Require(rim);
}

}  // namespace

void AddRoundTable(const RoundTable& table, const CategorySizes& sizes, GrammarBuilder* builder) {
  const CategorySize& size = SizeOf(sizes, table.category);
  builder->And(Welded("table", table.category),
               {Always("tabletop", Offset(0.0, 0.0, size.height))});
  builder->And(Surface("tabletop"), {Always("settings"), Always("middle")});
  AddRoundTableSettings(table, builder);
  AddMiddle(table, sizes, builder);
  if (table.chairs) AddChairs(builder);
  KeepOut apart;
  apart.name = "between objects on a table";
  apart.bodies = {
      {"plate", 0.14}, {"cup", 0.07}, {"teapot", 0.10}, {"serving_dish", 0.20}, {"steamer", 0.12}};
  builder->Require(apart);
  RequireInside({"cup", "teapot", "serving_dish", "steamer"}, size.Radius(), kRoundTableRimMargin,
                builder);
  // Plates stand nearer to the rim than that, at 0.5 m, but do not overhang it.
  RequireInside({"plate"}, size.Radius(), SizeOf(sizes, "plate").Radius(), builder);
}

}  // namespace simwright::scene
