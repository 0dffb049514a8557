#include "scene/grammar/dimsum.h"

#include <numbers>

#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {
namespace {

// Probabilities, radii and counts are those of Pfaff et al., Steerable Scene Generation, appendix,
// after Izatt and Tedrake's dimsum tables; deviations are ours, and so is that one of the numbers
// from 1 to the most is as likely as the other.
constexpr double kSettingRadius = 0.5;     // m, of the plates' middles about the table's
constexpr double kPlateDeviation = 0.015;  // m
constexpr double kCupAside = 0.25;         // m, from the plate
constexpr double kCupDeviation = 0.02;     // m
constexpr double kRimMargin = 0.15;        // m
constexpr int kMostEntries = 34;           // of a scene, the table among them

const std::vector<double> kOneOrTwo = {0.0, 1.0, 1.0};
const std::vector<double> kOneToFour = {0.0, 1.0, 1.0, 1.0, 1.0};

void AddSettings(GrammarBuilder* builder) {
  using Eigen::Vector3d;
  const Vector3d plate(kPlateDeviation, kPlateDeviation, 0.0);
  const Vector3d cup(kCupDeviation, kCupDeviation, 0.0);
  std::vector<Child> places;
  for (int i = 0; i < 4; ++i) {
    // A setting's x points to the table's middle.
    const double angle = 0.5 * std::numbers::pi * i;
    places.push_back(Always(
        "setting", Offset(-kSettingRadius * std::cos(angle), -kSettingRadius * std::sin(angle))
                       .Turned(angle)));
  }
  builder->And("settings", places);
  builder->Or("setting", {With(0.7, "plate_and_cup"), With(0.025, "plate_alone"),
                          With(0.025, "cup_alone"), With(0.2, kNothing)});
  const Child a_plate = Always("plate", GaussianOffset(Vector3d::Zero(), plate));
  const Child a_cup =
      Always("cup", GaussianOffset(Vector3d(0.0, -kCupAside, 0.0), cup).FacingAnyWay());
  builder->And("plate_and_cup", {a_plate, a_cup});
  builder->And("plate_alone", {a_plate});
  builder->And("cup_alone", {a_cup});
  builder->Leaf(Object("plate", "plate"));
  builder->Leaf(Object("cup", "cup"));
}

void AddMiddle(const SlotSizes& sizes, GrammarBuilder* builder) {
  const double reach = SizeOf(sizes, "table_round").Radius() - kRimMargin;
  const PoseRule anywhere =
      UniformOnSurface({-reach, -reach, 0.0}, {reach, reach, 0.0}).FacingAnyWay();
  builder->Independent(
      "middle", {With(0.9, "teapots"), With(0.6, "serving_dishes"), With(0.9, "steamer_stacks")});
  builder->Repeat("teapots", kOneOrTwo, Always("teapot", anywhere));
  builder->Repeat("serving_dishes", kOneOrTwo, Always("serving_dish", anywhere));
  builder->Repeat("steamer_stacks", kOneToFour, Always("steamer", anywhere));
  builder->Leaf(Object("teapot", "teapot"));
  builder->Leaf(Object("serving_dish", "serving_dish"));
  const double high = SizeOf(sizes, "steamer").height;
  builder->Or(Object("steamer", "steamer"),
              {With(0.25, "steamer", Offset(0.0, 0.0, high)),
               With(0.4, "steamer_lid", Offset(0.0, 0.0, high)), With(0.35, kNothing)});
  builder->Leaf(Object("steamer_lid", "steamer_lid"));
}

void RequireOnTable(const std::vector<std::string>& symbols, const SlotSize& table, double margin,
                    GrammarBuilder* builder) {
  InsideRim rim;
  rim.surface = "tabletop";
  rim.symbols = symbols;
  rim.round = true;
  rim.half_x = table.Radius();
  rim.margin = margin;
  builder->Require(rim);
}

}  // namespace

Grammar DimsumTable(const SlotSizes& sizes) {
  const SlotSize& table = SizeOf(sizes, "table_round");
  GrammarBuilder builder("dimsum", "room");
  builder.And("room", {Always("table")});
  builder.And(Welded("table", "table_round"), {Always("tabletop", Offset(0.0, 0.0, table.height))});
  builder.And(Surface("tabletop"), {Always("settings"), Always("middle")});
  AddSettings(&builder);
  AddMiddle(sizes, &builder);
  builder.Require(TallestStackAtLeast("steamer", 4));
  builder.Require(StacksAtLeast("steamer", 3));
  builder.Require(EntriesAtMost(kMostEntries));
  KeepOut apart;
  apart.name = "between what stands on the table";
  apart.bodies = {
      {"plate", 0.14}, {"cup", 0.07}, {"teapot", 0.10}, {"serving_dish", 0.20}, {"steamer", 0.12}};
  builder.Require(apart);
  RequireOnTable({"teapot", "serving_dish", "steamer"}, table, kRimMargin, &builder);
  // Settings stand nearer to the rim than that, but not over it.
  RequireOnTable({"plate"}, table, SizeOf(sizes, "plate").Radius(), &builder);
  RequireOnTable({"cup"}, table, SizeOf(sizes, "cup").Radius(), &builder);
  return builder.Build();
}

}  // namespace simwright::scene
