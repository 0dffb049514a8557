#include <algorithm>

#include "library/box_union.h"
#include "library/rigid/revolved_parts.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// The furniture that supports the scenes of grammars. Sizes are those that the grammars assume, in
// metres; the seed samples the finish and the density of the wood.
namespace simwright::library {
namespace {

core::Material Finish(RigidDraft* d) {
  const core::Material kFinishes[] = {
      Look("oak", .76f, .58f, .38f), Look("walnut", .45f, .30f, .20f),
      Look("beech", .82f, .66f, .46f), Look("white paint", .93f, .93f, .90f)};
  return kFinishes[UniformIndex(d->draws, std::size(kFinishes))];
}

FurnitureBox Between(double x0, double x1, double y0, double y1, double z0, double z1,
                     int look = 0) {
  return {Eigen::AlignedBox3d(Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1)), look};
}

core::TexturedMesh OfPlanks(RigidDraft* d, const std::vector<FurnitureBox>& planks,
                            const std::vector<core::Material>& looks) {
  d->parts = FurnitureBoxParts(planks);
  return BoxUnion(planks, looks);
}

constexpr int kTopCorners = 32;  // corners of a round table top's part

constexpr double kRoundRadius = 0.625, kRoundHeight = 0.785, kRoundTop = 0.028;  // m

// Returns a round table: a waisted column on a broad foot.
core::TexturedMesh RoundTable(RigidDraft* d) {
  const double under = kRoundHeight - kRoundTop;
  const ProfilePoint foot{0.30, 0.0}, edge{0.30, 0.025}, low{0.075, 0.08}, waist{0.05, 0.42},
      high{0.075, 0.72}, block{0.18, under};
  const ProfilePoint bottom{kRoundRadius, under}, top{kRoundRadius, kRoundHeight};
  d->parts = {RevolvedHull({foot, edge, low}), RevolvedHull({low, waist}),
              RevolvedHull({waist, high}), RevolvedHull({high, block}),
              RevolvedHull({bottom, top}, kTopCorners)};
  return Revolved({{0, 0}, foot, edge, low, waist, high, block, bottom, top, {0, kRoundHeight}},
                  {Finish(d)});
}

// Returns a restaurant table: a straight column between a flat foot and a plate.
core::TexturedMesh RestaurantTable(RigidDraft* d) {
  constexpr double kColumn = 0.045, kFootEdge = 0.02, kFootHigh = 0.045, kPlate = 0.015;
  const double under = kRoundHeight - kRoundTop, plate = under - kPlate;
  const ProfilePoint foot{0.31, 0.0}, edge{0.31, kFootEdge}, low{kColumn, kFootHigh},
      high{kColumn, plate}, plate_low{0.22, plate, 1}, plate_high{0.22, under, 1};
  const ProfilePoint bottom{kRoundRadius, under, 1}, top{kRoundRadius, kRoundHeight, 1};
  d->parts = {RevolvedHull({foot, edge, low}), RevolvedHull({low, high}),
              RevolvedHull({plate_low, plate_high}), RevolvedHull({bottom, top}, kTopCorners)};
  return Revolved(
      {{0, 0}, foot, edge, low, high, plate_low, plate_high, bottom, top, {0, kRoundHeight, 1}},
      {Look("black paint", .16f, .15f, .15f), Finish(d)});
}

constexpr double kBreakfastX = 0.3575, kBreakfastY = 0.7, kBreakfastHeight = 0.75;  // m, half sides

// Returns a breakfast table: four legs and an apron.
core::TexturedMesh BreakfastTable(RigidDraft* d) {
  constexpr double kTop = 0.025, kLeg = 0.06, kInset = 0.04, kApron = 0.08, kThick = 0.02;
  const double under = kBreakfastHeight - kTop;
  const double x = kBreakfastX - kInset, y = kBreakfastY - kInset;
  std::vector<FurnitureBox> planks = {
      Between(-kBreakfastX, kBreakfastX, -kBreakfastY, kBreakfastY, under, kBreakfastHeight)};
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      planks.push_back(Between(std::min(sx * x, sx * (x - kLeg)), std::max(sx * x, sx * (x - kLeg)),
                               std::min(sy * y, sy * (y - kLeg)), std::max(sy * y, sy * (y - kLeg)),
                               0.0, under));
    }
    // The apron is centred on the legs' sides.
    const double ax = sx * (x - 0.5 * kLeg), ay = sx * (y - 0.5 * kLeg);
    planks.push_back(
        Between(ax - 0.5 * kThick, ax + 0.5 * kThick, -y + kLeg, y - kLeg, under - kApron, under));
    planks.push_back(
        Between(-x + kLeg, x - kLeg, ay - 0.5 * kThick, ay + 0.5 * kThick, under - kApron, under));
  }
  return OfPlanks(d, planks, {Finish(d)});
}

// The shelf is 0.6 m wide, with sides of 0.783 m between the lowest and the uppermost board.
constexpr double kShelfX = 0.15, kShelfY = 0.3, kShelfBoard = 0.017, kShelfWall = 0.015;  // m
constexpr double kShelfSurfaces[] = {0.017, 0.287, 0.547, 0.817};  // m, height of its boards' upper
                                                                   // sides

// Returns a shelf of four boards, two sides and a back, open to -x.
core::TexturedMesh Shelf(RigidDraft* d) {
  const double bottom = kShelfSurfaces[0], top = kShelfSurfaces[3] - kShelfBoard;
  const double inside = kShelfY - kShelfWall, front = kShelfX - kShelfWall;
  std::vector<FurnitureBox> planks;
  for (const double surface : kShelfSurfaces) {
    const bool between = surface > bottom && surface < top;
    planks.push_back(Between(-kShelfX, between ? front : kShelfX, between ? -inside : -kShelfY,
                             between ? inside : kShelfY, surface - kShelfBoard, surface));
  }
  planks.push_back(Between(-kShelfX, kShelfX, -kShelfY, -inside, bottom, top));
  planks.push_back(Between(-kShelfX, kShelfX, inside, kShelfY, bottom, top));
  planks.push_back(Between(front, kShelfX, -inside, inside, bottom, top, 1));
  const core::Material finish = Finish(d);
  return OfPlanks(d, planks, {finish, {"back", 0.92f * finish.base_color, -1}});
}

constexpr double kChairX = 0.22, kChairY = 0.24, kChairHeight = 0.9;  // m, half sides

// Returns a chair that faces x, like a table setting; its posts and rails are behind.
core::TexturedMesh Chair(RigidDraft* d) {
  constexpr double kSeat = 0.46, kThick = 0.03, kLeg = 0.04, kOut = 0.23, kRail = 0.02;
  const double rear = -kChairX + kLeg, rail = -kChairX + 0.5 * (kLeg - kRail);
  std::vector<FurnitureBox> planks = {
      Between(rear, kChairX, -kChairY, kChairY, kSeat - kThick, kSeat, 1)};
  for (const double side : {-kOut, kOut - kLeg}) {
    planks.push_back(Between(-kChairX, rear, side, side + kLeg, 0.0, kChairHeight));
    planks.push_back(
        Between(kChairX - 0.05, kChairX - 0.05 + kLeg, side, side + kLeg, 0.0, kSeat - kThick));
  }
  for (const auto& [low, high] : {std::pair(0.58, 0.65), std::pair(0.74, 0.87)}) {
    planks.push_back(Between(rail, rail + kRail, -kOut + kLeg, kOut - kLeg, low, high));
  }
  const core::Material finish = Finish(d);
  return OfPlanks(d, planks, {finish, {"seat", 0.88f * finish.base_color, -1}});
}

constexpr double kFloorSide = 10.0, kFloorThick = 0.05;  // m

core::TexturedMesh Floor(RigidDraft* d) {
  const core::Material kScreeds[] = {Look("screed", .62f, .61f, .58f),
                                     Look("tile", .70f, .60f, .50f),
                                     Look("slate", .40f, .42f, .44f)};
  const core::Material look = kScreeds[UniformIndex(d->draws, std::size(kScreeds))];
  const double half = 0.5 * kFloorSide;
  return OfPlanks(d, {Between(-half, half, -half, half, 0.0, kFloorThick)}, {look});
}

}  // namespace

const std::vector<RigidKind>& FurnitureKinds() {
  using S = SizeSymmetry;
  static const std::vector<RigidKind> kKinds = {
      {"table_round",
       "round table",
       "1.25 m across, on a column",
       S::kRound,
       RoundTable,
       {2.0 * kRoundRadius, 2.0 * kRoundRadius, kRoundHeight}},
      {"table_restaurant",
       "round table",
       "1.25 m across, on a column and a plate",
       S::kRound,
       RestaurantTable,
       {2.0 * kRoundRadius, 2.0 * kRoundRadius, kRoundHeight}},
      {"table_breakfast",
       "breakfast table",
       "1.4 m by 0.715 m, four legs",
       S::kFree,
       BreakfastTable,
       {2.0 * kBreakfastX, 2.0 * kBreakfastY, kBreakfastHeight}},
      {"shelf_living_room",
       "shelving unit",
       "four boards, open to -x",
       S::kFree,
       Shelf,
       {2.0 * kShelfX, 2.0 * kShelfY, kShelfSurfaces[3]}},
      {"shelf_pantry",
       "shelving unit",
       "four boards, open to -x",
       S::kFree,
       Shelf,
       {2.0 * kShelfX, 2.0 * kShelfY, kShelfSurfaces[3]}},
      {"chair",
       "wooden chair",
       "with a back, facing x",
       S::kFree,
       Chair,
       {2.0 * kChairX, 2.0 * kChairY, kChairHeight}},
      {"floor",
       "floor slab",
       "10 m by 10 m",
       S::kFree,
       Floor,
       {kFloorSide, kFloorSide, kFloorThick}}};
  return kKinds;
}

}  // namespace simwright::library
