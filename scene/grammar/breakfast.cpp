#include "scene/grammar/breakfast.h"

#include <numbers>

#include "scene/grammar/grammar_builder.h"

namespace simwright::scene {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// What differs between the two; probabilities and counts are those of Pfaff et al., Steerable Scene
// Generation, appendix.
struct Clutter {
  std::vector<double> pairs;                   // m, y of each pair of settings
  double plate = 0.0, bowl = 0.0, none = 0.0;  // what a setting has
  int most_plates = 0, most_bowls = 0;         // that are shared
  double cereal_stop = 0.0;
  bool crock = false;
  int most_entries = 0;  // of a scene, the table among them
};

constexpr double kSettingFromMiddle = 0.2;          // m, along x
constexpr double kSharedX = 0.3, kSharedY = 0.6;    // m, from the middle
constexpr double kCrock = 0.7, kCrockGoesOn = 0.1;  // and where its utensils stop
constexpr int kMostUtensils = 10, kFewestObjects = 3;
// Ours: how far what lies about a plate is from its middle, and by how much that varies.
constexpr double kCutleryAside = 0.14, kTop = 0.13, kMugAside = 0.15, kDeviation = 0.008;  // m
constexpr double kPairsApart = 0.45;                                                       // m
constexpr double kAskew = 0.06;                                                            // rad

PoseRule About(double x, double y) {
  return GaussianOffset({x, y, 0.0}, {kDeviation, kDeviation, 0.0}).Turned(0.0, kAskew);
}

// A setting's x points to the table's middle: left of it is y, and its top x.
void AddSettings(const Clutter& clutter, const SlotSizes& sizes, GrammarBuilder* builder) {
  std::vector<Child> places;
  for (const double y : clutter.pairs) {
    places.push_back(Always("setting", Offset(-kSettingFromMiddle, y)));
    places.push_back(Always("setting", Offset(kSettingFromMiddle, y).Turned(std::numbers::pi)));
  }
  builder->And("settings", places);
  builder->Or("setting", {With(clutter.plate, "plate_setting"), With(clutter.bowl, "bowl"),
                          With(clutter.none, kNothing)});
  builder->Independent(
      "plate_setting",
      {With(1.0, "full_plate", GaussianOffset(Vector3d::Zero(), {kDeviation, kDeviation, 0.0})),
       With(0.7, "fork", About(0.0, kCutleryAside)), With(0.8, "knife", About(0.0, -kCutleryAside)),
       With(1.0, "top_spoon", About(kTop, 0.0)), With(0.8, "mug", About(kTop, -kMugAside))});
  builder->Or("top_spoon", {With(0.2, "spoon", Offset(0, 0).Turned(0.5 * std::numbers::pi)),
                            With(0.2, "teaspoon", Offset(0, 0).Turned(0.5 * std::numbers::pi)),
                            With(0.6, kNothing)});
  const PoseRule on_it = Offset(0.0, 0.0, SizeOf(sizes, "plate").rest_height).FacingAnyWay();
  builder->Or(Object("full_plate", "plate"),
              {With(0.2, "toast", on_it), With(0.1, "apple", on_it), With(0.1, "pear", on_it),
               With(0.2, "bowl", on_it), With(0.4, kNothing)});
}

void AddShared(const Clutter& clutter, GrammarBuilder* builder) {
  const PoseRule anywhere =
      UniformOnSurface({-kSharedX, -kSharedY, 0.0}, {kSharedX, kSharedY, 0.0}).FacingAnyWay();
  builder->Repeat("plates", GeometricWeights(0.7, 0, clutter.most_plates),
                  Always("plate", anywhere));
  builder->Repeat("bowls", GeometricWeights(0.7, 0, clutter.most_bowls), Always("bowl", anywhere));
  builder->Repeat("cereal", GeometricWeights(clutter.cereal_stop, 0, 3),
                  Always("cereal_box", anywhere));
  builder->Repeat("jugs", GeometricWeights(0.6, 0, 2), Always("jug", anywhere));
  std::vector<Child> shared = {Always("plates"), Always("bowls"), Always("cereal"), Always("jugs")};
  if (clutter.crock) shared.push_back(Always("maybe_crock"));
  builder->And("shared", shared);
  if (clutter.crock) {
    builder->Independent("maybe_crock", {With(kCrock, "utensil_crock", anywhere)});
  }
}

// Utensils lie along x: stood up, x points upwards. They lean as the crock lets them, once physics
// has them.
void AddCrock(const SlotSizes& sizes, GrammarBuilder* builder) {
  const SlotSize& crock = SizeOf(sizes, "utensil_crock");
  const Quaterniond upright(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3d::UnitY()));
  std::vector<Child> choices;
  for (const char* slot : {"fork", "knife", "spoon", "teaspoon"}) {
    const double high = crock.rest_height + SizeOf(sizes, slot).half_size.x();
    const double aside = 0.3 * crock.Radius();
    choices.push_back(With(
        1.0, slot,
        GaussianOffset({0.0, 0.0, high}, {aside, aside, 0.0}).Rotated(upright, Vector3d::Zero())));
  }
  builder->Or("utensil", choices);
  builder->Repeat(Object("utensil_crock", "utensil_crock"),
                  GeometricWeights(kCrockGoesOn, 0, kMostUtensils),
                  Always("utensil", SamePose().FacingAnyWay()));
}

Grammar BreakfastTable(const std::string& name, const Clutter& clutter, const SlotSizes& sizes) {
  const SlotSize& table = SizeOf(sizes, "table_breakfast");
  GrammarBuilder builder(name, "room");
  builder.And("room", {Always("table")});
  builder.And(Welded("table", "table_breakfast"),
              {Always("tabletop", Offset(0.0, 0.0, table.height))});
  builder.And(Surface("tabletop"), {Always("settings"), Always("shared")});
  AddSettings(clutter, sizes, &builder);
  AddShared(clutter, &builder);
  if (clutter.crock) AddCrock(sizes, &builder);
  for (const char* slot : {"plate", "bowl", "fork", "knife", "spoon", "teaspoon", "mug", "toast",
                           "apple", "pear", "cereal_box", "jug"}) {
    builder.Leaf(Object(slot, slot));
  }
  builder.Require(ObjectsAtLeast(kFewestObjects));
  builder.Require(EntriesAtMost(clutter.most_entries));
  return builder.Build();
}

}  // namespace

Grammar BreakfastTableLow(const SlotSizes& sizes) {
  Clutter clutter;
  clutter.pairs = {0.0};
  clutter.plate = 0.7, clutter.bowl = 0.2, clutter.none = 0.1;
  clutter.most_plates = clutter.most_bowls = 2;
  clutter.cereal_stop = 0.3;
  clutter.crock = true;
  clutter.most_entries = 35;
  return BreakfastTable("breakfast_low", clutter, sizes);
}

Grammar BreakfastTableHigh(const SlotSizes& sizes) {
  Clutter clutter;
  clutter.pairs = {-kPairsApart, 0.0, kPairsApart};
  clutter.plate = 0.6, clutter.bowl = clutter.none = 0.2;
  clutter.most_plates = 4;
  clutter.most_bowls = 6;
  clutter.cereal_stop = 0.4;
  clutter.most_entries = 46;
  return BreakfastTable("breakfast_high", clutter, sizes);
}

}  // namespace simwright::scene
