#include <algorithm>
#include <string>
#include <vector>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kRefrigeratorDoor = 0.055;  // m, thickness, with its insulation
constexpr double kRefrigeratorWall = 0.045;  // m
constexpr double kRefrigeratorFoot = 0.04;   // m, height of the plinth

struct Compartment {
  double low, high;  // m, of the cell with its walls
  int shelves;
};

}  // namespace

assets::ArticulatedAsset MakeRefrigerator(const Options& options) {
  Assembly a("refrigerator", "refrigerator", options);
  const double across = a.parameters().length.sample, deep = a.parameters().width.sample;
  const double high = a.parameters().height.sample;
  const double front = -0.5 * deep, rear = 0.5 * deep, inner = front + kRefrigeratorDoor + kGap;
  const Matter casing =
      a.Bernoulli(0.3) ? Matter{"steel_enamel", "appliance", 370.0, {0.72f, 0.73f, 0.75f, 1.0f}}
                       : Casing(a.draws());
  const int body = a.AddRoot("body", "body");
  a.Add(body, BlackPlastic(),
        Box({inner + 0.03, -0.48 * across, 0.0}, {rear, 0.48 * across, kRefrigeratorFoot}, 0.0));
  std::vector<Compartment> cells;
  const bool two = high > 1.1;
  if (two) {
    // The freezer is below or above.
    const double split =
        kRefrigeratorFoot + (a.Bernoulli(0.5) ? 0.36 : 0.66) * (high - kRefrigeratorFoot);
    cells = {{kRefrigeratorFoot, split, split < 0.5 * high ? 1 : 3},
             {split, high, split < 0.5 * high ? 3 : 1}};
  } else {
    cells = {{kRefrigeratorFoot, high, 2}};
  }
  a.RecordFeature("doors", two ? "two" : "one");
  const double side = a.Bernoulli(0.5) ? 1.0 : -1.0;
  a.RecordFeature("hinge", side > 0.0 ? "left" : "right");
  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  const double upper = a.Draw(1.6, 2.2), standoff = a.Draw(0.038, 0.046);
  for (size_t i = 0; i < cells.size(); ++i) {
    const Compartment& cell = cells[i];
    a.Add(body, casing,
          CarcassPanels(Bounds(inner, rear, -0.5 * across, 0.5 * across, cell.low, cell.high),
                        kRefrigeratorWall));
    for (int k = 1; k <= cell.shelves; ++k) {
      const double z = cell.low + (cell.high - cell.low) * k / (cell.shelves + 1);
      a.Add(body, ClearGlass(),
            Box({inner + 0.05, -0.5 * across + kRefrigeratorWall, z},
                {rear - kRefrigeratorWall, 0.5 * across - kRefrigeratorWall, z + 0.005}, 0.0));
    }
    const std::string number = two ? "_" + std::to_string(i) : "";
    const double low = cell.low + 0.5 * kGap,
                 top = cell.high - (i + 1 < cells.size() ? 0.5 : 0.0) * kGap;
    const int door =
        a.AddLink("door" + number, "door", body,
                  SideHinge(front + kRefrigeratorDoor, side * 0.5 * across, 0.5 * (low + top),
                            upper, SampleJointResistance(a.draws(), across)));
    a.Add(door, casing,
          Box({front, -0.5 * across, low}, {front + kRefrigeratorDoor, 0.5 * across, top}, 0.006));
    HandlePlacement place;
    place.mount = {front, -side * (0.5 * across - 0.045), 0.5 * (low + top)};
    place.out = -Eigen::Vector3d::UnitX();
    place.along = Eigen::Vector3d::UnitZ();
    place.length = std::min(0.6 * (top - low), 0.5);
    place.standoff = standoff;
    a.AddHandle("handle_" + std::to_string(i), door, kind, place, BrushedSteel());
  }
  return a.Finish("appliance");
}

}  // namespace simwright::library
