#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kDrawerUnitBoard = 0.018;  // m, of the carcass and the fronts
constexpr double kThin = 0.012;             // m, of the drawers' sides
constexpr double kBottom = 0.009;           // m, of the drawers' bottoms
constexpr double kRunner = 0.006;           // m, between a drawer and the carcass's sides
constexpr double kDrawerUnitPlinth = 0.05;  // m
constexpr double kTallestNightstand = 0.7;  // m
constexpr double kDrawerHeight = 0.2;       // m, approximate height of the fronts

struct Cell {
  double front, rear;  // m, x of the unit
  double half;         // m, half the width of the unit
  double low, high;    // m, of the drawer's front
};

void AddDrawer(Assembly* a, int body, int index, const Cell& c, const Matter& board,
               HandleKind kind, const Matter& metal) {
  const std::string number = std::to_string(index);
  JointPlan plan;
  plan.type = assets::JointType::kPrismatic;
  plan.origin = {c.front, 0.0, 0.5 * (c.low + c.high)};
  plan.axis = -Eigen::Vector3d::UnitX();
  const double depth =
      c.rear - kDrawerUnitBoard - c.front - kDrawerUnitBoard - 2 * kGap;  // of the box
  plan.upper = 0.75 * depth;
  plan.joint_resistance = SampleJointResistance(a->draws());
  const int drawer = a->AddLink("drawer_" + number, "drawer", body, plan);
  a->Add(drawer, board,
         Box({c.front, -c.half, c.low}, {c.front + kDrawerUnitBoard, c.half, c.high}, 0.003));
  const double half = c.half - kDrawerUnitBoard - kRunner;
  const double x0 = c.front + kDrawerUnitBoard, x1 = x0 + depth;
  const double z0 = c.low + kDrawerUnitBoard + kRunner, z1 = c.high - 0.03;
  const Matter inside = MatterOf("plywood", "birch", 0.85f, 0.74f, 0.56f);
  a->Add(drawer, inside, Box({x0, -half, z0}, {x1, half, z0 + kBottom}, 0.0));
  a->Add(drawer, inside, Box({x0, -half, z0 + kBottom}, {x1, -half + kThin, z1}, 0.0));
  a->Add(drawer, inside, Box({x0, half - kThin, z0 + kBottom}, {x1, half, z1}, 0.0));
  a->Add(drawer, inside,
         Box({x1 - kThin, -half + kThin, z0 + kBottom}, {x1, half - kThin, z1}, 0.0));
  HandlePlacement place;
  place.mount = {c.front, 0.0, 0.5 * (c.low + c.high)};
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitY();
  place.length = std::min(0.16, c.half);
  place.standoff = 0.036;
  a->AddHandle("handle_" + number, drawer, kind, place, metal);
}

}  // namespace

assets::ArticulatedAsset MakeDrawerUnit(const Options& options) {
  const bool nightstand =
      options.size ? options.size->z() < kTallestNightstand : options.seed % 2 == 0;
  Assembly a("drawer_unit", nightstand ? "nightstand" : "chest of drawers", options);
  const double across = a.parameters().length.sample, deep = a.parameters().width.sample;
  const double high = a.parameters().height.sample;
  const double front = -0.5 * deep, rear = 0.5 * deep, inner = front + kDrawerUnitBoard + kGap;
  const Matter board = Board(a.draws());
  const int body = a.AddRoot("body", "body");
  a.Add(body, board,
        Box({inner + 0.03, -0.5 * across + 0.02, 0.0},
            {inner + 0.03 + kDrawerUnitBoard, 0.5 * across - 0.02, kDrawerUnitPlinth}, 0.0));
  a.Add(body, board,
        Box({rear - kDrawerUnitBoard, -0.5 * across + 0.02, 0.0},
            {rear, 0.5 * across - 0.02, kDrawerUnitPlinth}, 0.0));
  a.Add(body, board,
        CarcassPanels(Bounds(inner, rear, -0.5 * across, 0.5 * across, kDrawerUnitPlinth, high),
                      kDrawerUnitBoard));
  const double low = kDrawerUnitPlinth, top = high - kDrawerUnitBoard - kGap;
  const int count = std::clamp(static_cast<int>((top - low) / kDrawerHeight + 0.5), 2, 5);
  a.RecordFeature("drawers", std::to_string(count));
  const HandleKind kind =
      SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow, HandleKind::kKnob});
  a.RecordFeature("handle", HandleName(kind));
  const Matter metal = FurnitureMetal(a.draws());
  for (int i = 0; i < count; ++i) {
    const double step = (top - low) / count;
    AddDrawer(
        &a, body, i,
        {front, rear, 0.5 * across, low + i * step + (i > 0 ? kGap : 0.0), low + (i + 1) * step},
        board, kind, metal);
  }
  return a.Finish("plywood");
}

}  // namespace simwright::library
