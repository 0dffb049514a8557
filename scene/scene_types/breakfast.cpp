#include "scene/scene_types/breakfast.h"

#include <numbers>

#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Probabilities, counts and positions are those of Pfaff et al., Steerable Scene Generation,
// appendix, and of its grammars (github.com/nepfaff/spatial_scene_grammars, tri_table), except
// where a comment says that a value is ours.

// The parameters that differ between the two tables.
struct BreakfastClutter {
  std::vector<Child> pairs;                    // pairs of settings with their positions
  double plate = 0.0, bowl = 0.0, none = 0.0;  // weights of the contents of a setting
  int most_plates = 0, most_bowls = 0;         // most shared ones
  double cereal_stop = 0.0;
  double another_slice = 0.0;  // probability of another slice on top
  bool crock = false;
  int most_entries = 0;  // most entries of a scene, the table included
};

constexpr double kFromMiddle = 0.2;                // m, of a setting from the middle, along x
constexpr double kSharedX = 0.3, kSharedY = 0.6;   // m, from the middle
constexpr double kBreakfastRimMargin = 0.1;        // m
constexpr double kCrock = 0.7, kCrockStops = 0.1;  // probability of a crock; stop probability of
                                                   // its utensils
constexpr int kMostUtensils = 10, kFewestObjects = 3;
constexpr double kLengthwise = 0.01;             // m, deviation of cutlery along its length
constexpr double kSettingDeviation = 0.02;       // m, of a setting
constexpr double kMugDeviation = 0.015;          // m, of a mug
constexpr double kCutleryConcentration = 100.0;  // of the yaw of cutlery
// Distances from the middle of a plate or bowl to the items beside it, m, and how far back these
// are. The sideways one is ours: as published, cutlery overlaps the rim of the plate by 5 mm.
constexpr double kBesidePlate = 0.12, kBackOfPlate = -0.05;
constexpr double kTopOfPlate = 0.13, kTopAside = 0.025;
constexpr double kMug = 0.13;
constexpr double kBesideBowl = 0.095, kTopOfBowl = 0.1;

// Cutlery that varies along its length, beside a plate or at its top.
PoseRule Beside(double x, double y) {
  return GaussianOffset({x, y, 0.0}, {kLengthwise, 0.0, 0.0})
      .WithYaw(0.0, DeviationOfConcentration(kCutleryConcentration));
}
PoseRule AtTop(double x, double y) {
  return GaussianOffset({x, y, 0.0}, {0.0, kLengthwise, 0.0})
      .WithYaw(0.5 * std::numbers::pi, DeviationOfConcentration(kCutleryConcentration));
}

// Returns the pose rule of an item on or in a dish.
PoseRule OnDish(const CategorySizes& sizes, const std::string& dish, double deviation) {
  return GaussianOffset({0.0, 0.0, SizeOf(sizes, dish).rest_height}, {deviation, deviation, 0.0})
      .WithFreeYaw();
}

// The x axis of a setting points to the table's middle: +y is its left side, and +x its top.
void AddBreakfastSettings(const BreakfastClutter& clutter, const CategorySizes& sizes,
                          GrammarBuilder* builder) {
  builder->And("settings", clutter.pairs);
  const Vector3d vary(kSettingDeviation, clutter.crock ? kSettingDeviation : 0.0, 0.0);
  builder->And(
      "pair",
      {Always("setting", GaussianOffset({-kFromMiddle, 0.0, 0.0}, vary)),
       Always("setting", GaussianOffset({kFromMiddle, 0.0, 0.0}, vary).WithYaw(std::numbers::pi))});
  builder->Or("setting", {With(clutter.plate, "plate_setting"), With(clutter.bowl, "bowl_setting"),
                          With(clutter.none, kNothing)});
  builder->Independent(
      "plate_setting",
      {With(1.0, "own_plate", SamePose().WithFreeYaw()),
       With(0.7, "fork", Beside(kBackOfPlate, kBesidePlate)),
       With(0.8, "knife", Beside(kBackOfPlate, -kBesidePlate)), With(1.0, "plate_spoon"),
       With(
           0.8, "mug",
           GaussianOffset({kMug, -kMug, 0.0}, {kMugDeviation, kMugDeviation, 0.0}).WithFreeYaw())});
  const PoseRule top_of_plate = AtTop(kTopOfPlate, kTopAside);
  builder->Or("plate_spoon", {With(0.2, "spoon", top_of_plate), With(0.2, "teaspoon", top_of_plate),
                              With(0.6, kNothing)});
  builder->Or(Object("own_plate", "plate"),
              {With(0.2, "toast", OnDish(sizes, "plate", 0.03)),
               With(0.1, "apple", OnDish(sizes, "plate", 0.025)),
               With(0.1, "pear", OnDish(sizes, "plate", 0.025)),
               With(0.2, "bowl", OnDish(sizes, "plate", 0.02)), With(0.4, kNothing)});
  builder->And("bowl_setting", {Always("own_bowl", SamePose().WithFreeYaw()), Always("right_spoon"),
                                Always("bowl_spoon")});
  builder->Or(Object("own_bowl", "bowl"),
              {With(0.1, "toast", OnDish(sizes, "bowl", 0.02)),
               With(0.1, "apple", OnDish(sizes, "bowl", 0.015)),
               With(0.1, "pear", OnDish(sizes, "bowl", 0.015)), With(0.7, kNothing)});
  const PoseRule right = Beside(kBackOfPlate, -kBesideBowl), top = AtTop(kTopOfBowl, kTopAside);
  builder->Or("right_spoon",
              {With(1.0, "spoon", right), With(1.0, "teaspoon", right), With(4.0, kNothing)});
  builder->Or("bowl_spoon",
              {With(1.0, "spoon", top), With(1.0, "teaspoon", top), With(4.0, kNothing)});
}

void AddShared(const BreakfastClutter& clutter, const CategorySizes& sizes,
               GrammarBuilder* builder) {
  const PoseRule anywhere =
      UniformOnSurface({-kSharedX, -kSharedY, 0.0}, {kSharedX, kSharedY, 0.0}).WithFreeYaw();
  builder->Repeat("plates", GeometricWeights(0.7, 0, clutter.most_plates),
                  Always("shared_plate", anywhere));
  builder->Repeat("bowls", GeometricWeights(0.7, 0, clutter.most_bowls),
                  Always("shared_bowl", anywhere));
  builder->Repeat("cereal", GeometricWeights(clutter.cereal_stop, 0, 3),
                  Always("cereal_box", anywhere));
  builder->Repeat("jugs", GeometricWeights(0.6, 0, 2), Always("jug", anywhere));
  std::vector<Child> shared = {Always("plates"), Always("bowls"), Always("cereal"), Always("jugs")};
  if (clutter.crock) shared.push_back(Always("maybe_crock"));
  builder->And("shared", shared);
  if (clutter.crock) {
    builder->Independent("maybe_crock", {With(kCrock, "utensil_crock", anywhere)});
  }
  builder->Or(Object("shared_plate", "plate"), {With(0.5, "toast", OnDish(sizes, "plate", 0.02)),
                                                With(0.25, "apple", OnDish(sizes, "plate", 0.015)),
                                                With(0.25, "pear", OnDish(sizes, "plate", 0.015))});
  builder->Or(Object("shared_bowl", "bowl"), {With(0.2, "toast", OnDish(sizes, "bowl", 0.015)),
                                              With(0.4, "apple", OnDish(sizes, "bowl", 0.015)),
                                              With(0.4, "pear", OnDish(sizes, "bowl", 0.015))});
}

// Utensils lie along x; upright ones point up with x. Physics lets them lean in the crock. The
// crock is ours except for its counts.
void AddCrock(const CategorySizes& sizes, GrammarBuilder* builder) {
  const CategorySize& crock = SizeOf(sizes, "utensil_crock");
  const Quaterniond upright(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3d::UnitY()));
  std::vector<Child> choices;
  for (const char* category : {"fork", "knife", "spoon", "teaspoon"}) {
    const double high = crock.rest_height + SizeOf(sizes, category).half_size.x();
    const double aside = 0.3 * crock.Radius();
    choices.push_back(With(1.0, category,
                           GaussianOffset({0.0, 0.0, high}, {aside, aside, 0.0})
                               .WithRotation(upright, Vector3d::Zero())));
  }
  builder->Or("utensil", choices);
  builder->Repeat(Object("utensil_crock", "utensil_crock"),
                  GeometricWeights(kCrockStops, 0, kMostUtensils),
                  Always("utensil", SamePose().WithFreeYaw()));
}

void AddFood(const BreakfastClutter& clutter, const CategorySizes& sizes, GrammarBuilder* builder) {
  const double slice = SizeOf(sizes, "toast").height;
  builder->Or(Object("toast", "toast"),
              {With(clutter.another_slice, "toast", Offset(0.0, 0.0, slice).WithFreeYaw()),
               With(1.0 - clutter.another_slice, kNothing)});
  builder->Leaf(Object("bowl", "bowl"));
  for (const char* category :
       {"fork", "knife", "spoon", "teaspoon", "mug", "apple", "pear", "cereal_box", "jug"}) {
    builder->Leaf(Object(category, category));
  }
}

// Both constraints are enforced by rejection, which favours tables with fewer objects: a shared
// object keeps its width away from the settings, and no object stands within 0.1 m of the rim.
void RequireBreakfastRoom(const BreakfastClutter& clutter, const CategorySizes& sizes,
                          GrammarBuilder* builder) {
  KeepOut apart;
  apart.name = "between shared objects and settings";
  apart.bodies = {{"shared_plate", 0.11}, {"shared_bowl", 0.08}, {"cereal_box", 0.15},
                  {"jug", 0.06},          {"own_plate", 0.0},    {"own_bowl", 0.0},
                  {"fork", 0.0},          {"knife", 0.0},        {"spoon", 0.0},
                  {"teaspoon", 0.0},      {"mug", 0.0}};
  apart.against = {"shared_plate", "shared_bowl", "cereal_box", "jug"};
  if (clutter.crock) {
    apart.bodies.push_back({"utensil_crock", SizeOf(sizes, "utensil_crock").Radius()});
    apart.against.push_back("utensil_crock");
  }
  apart.exempt_within = "shared";
  apart.decision = Decision::kReject;
  builder->Require(apart);
  const CategorySize& table = SizeOf(sizes, "table_breakfast");
  InsideRim rim;
  rim.surface = "tabletop";
  rim.half_x = table.half_size.x();
  rim.half_y = table.half_size.y();
  rim.margin = kBreakfastRimMargin;
  rim.decision = Decision::kReject;
  builder->Require(rim);
}

Grammar BreakfastTable(const std::string& name, const BreakfastClutter& clutter,
                       const CategorySizes& sizes) {
  const CategorySize& table = SizeOf(sizes, "table_breakfast");
  GrammarBuilder builder(name, "room");
  builder.And("room", {Always("table")});
  builder.And(Welded("table", "table_breakfast"),
              {Always("tabletop", Offset(0.0, 0.0, table.height))});
  builder.And(Surface("tabletop"), {Always("settings"), Always("shared")});
  AddBreakfastSettings(clutter, sizes, &builder);
  AddShared(clutter, sizes, &builder);
  if (clutter.crock) AddCrock(sizes, &builder);
  AddFood(clutter, sizes, &builder);
  RequireBreakfastRoom(clutter, sizes, &builder);
  builder.Require(ObjectsAtLeast(kFewestObjects));
  builder.Require(EntriesAtMost(clutter.most_entries));
  return builder.Build();
}

}  // namespace

Grammar BreakfastTableLow(const CategorySizes& sizes) {
  BreakfastClutter clutter;
  clutter.pairs = {Always("pair", GaussianOffset(Vector3d::Zero(), {0.0, 0.2, 0.0}))};
  clutter.plate = 0.7, clutter.bowl = 0.2, clutter.none = 0.1;
  clutter.most_plates = clutter.most_bowls = 2;
  clutter.cereal_stop = 0.3;
  clutter.another_slice = 0.2;
  clutter.crock = true;
  clutter.most_entries = 35;
  return BreakfastTable("breakfast_low", clutter, sizes);
}

Grammar BreakfastTableHigh(const CategorySizes& sizes) {
  BreakfastClutter clutter;
  for (const auto& [low, high] : {std::pair(-0.52, -0.3), {-0.08, 0.08}, {0.3, 0.52}}) {
    clutter.pairs.push_back(Always("pair", UniformOnSurface({0.0, low, 0.0}, {0.0, high, 0.0})));
  }
  clutter.plate = 0.6, clutter.bowl = clutter.none = 0.2;
  clutter.most_plates = 4;
  clutter.most_bowls = 6;
  clutter.cereal_stop = 0.4;
  clutter.another_slice = 0.25;
  clutter.most_entries = 46;
  return BreakfastTable("breakfast_high", clutter, sizes);
}

}  // namespace simwright::scene
