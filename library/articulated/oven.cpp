#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kOvenDoor = 0.034;    // m, thickness
constexpr double kOvenWall = 0.045;    // m, with its insulation
constexpr double kTallestDoor = 0.46;  // m: taller doors are too heavy to lift by hand
constexpr double kOvenPlinth = 0.13;   // m: keeps the open door and its handle above the floor

void AddRack(Assembly* a, int body, const Eigen::AlignedBox3d& chamber, double z) {
  constexpr int kWires = 7;
  for (int i = 0; i < kWires; ++i) {
    const double y = chamber.min().y() + (i + 0.5) / kWires * chamber.sizes().y();
    a->Add(body, BrushedSteel(),
           Rod({chamber.min().x() + 0.02, y, z}, {chamber.max().x(), y, z}, 0.002, 6));
  }
}

void AddBurners(Assembly* a, int body, double deep, double across, double top) {
  for (const double x : {-0.22, 0.20}) {
    for (const double y : {-0.24, 0.24}) {
      const Eigen::Vector3d foot(x * deep, y * across, top);
      a->Paint(body, BlackPlastic(),
               Rod(foot, foot + Eigen::Vector3d(0, 0, 0.004), 0.14 * across, 28));
    }
  }
}

}  // namespace

assets::ArticulatedAsset MakeOven(const Options& options) {
  Assembly a("oven", "oven", options);
  const double across = a.parameters().length.sample, deep = a.parameters().width.sample;
  const double high = a.parameters().height.sample;
  const double front = -0.5 * deep, rear = 0.5 * deep, inner = front + kOvenDoor + kGap;
  const double panel = a.Draw(0.10, 0.12);  // height of the control panel
  const double plinth = std::max(kOvenPlinth, high - panel - kTallestDoor);  // a warming drawer
  const Matter casing = Casing(a.draws());
  const int body = a.AddRoot("body", "body");
  a.Add(body, casing, Box({inner + 0.02, -0.5 * across, 0.0}, {rear, 0.5 * across, plinth}));
  const double shell_top = high - panel;
  const Eigen::AlignedBox3d shell =
      Bounds(inner, rear, -0.5 * across, 0.5 * across, plinth, shell_top);
  a.Add(body, casing, CarcassPanels(shell, kOvenWall));
  a.Add(body, casing, Box({front, -0.5 * across, shell_top}, {rear, 0.5 * across, high}));
  const Eigen::AlignedBox3d chamber = Bounds(inner, rear - kOvenWall, -0.5 * across + kOvenWall,
                                             0.5 * across - kOvenWall, plinth, shell_top);
  AddRack(&a, body, chamber, plinth + 0.4 * (shell_top - plinth));
  const bool stove = high > 0.75;
  if (stove) AddBurners(&a, body, deep, across, high);
  a.RecordFeature("cooktop", stove ? "four burners" : "none");
  a.Paint(body, DarkGlass(),
          Box({front - 0.0008, -0.12 * across, high - 0.75 * panel},
              {front + 0.001, 0.12 * across, high - 0.3 * panel}, 0.0));

  const double top = shell_top - kGap;
  const int door = a.AddLink("door", "door", body,
                             BottomHinge(front + kOvenDoor, plinth, a.Draw(1.4, 1.55),
                                         SampleJointResistance(a.draws(), top - plinth)));
  const Eigen::AlignedBox3d slab =
      Bounds(front, front + kOvenDoor, -0.5 * across, 0.5 * across, plinth, top);
  const double border = 0.09;
  a.Add(door, casing, FrameBars(slab, border));
  a.Add(door, DarkGlass(), Pane(slab, border, 0.006));
  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  HandlePlacement place;
  place.mount = {front, 0.0, top - 0.045};
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitY();
  place.length = a.Draw(0.6, 0.85) * across;
  place.standoff = a.Draw(0.036, 0.044);
  a.AddHandle("handle_0", door, kind, place, BrushedSteel());

  const int dials = 2 * static_cast<int>(a.Draw(1.0, 2.999));
  const Matter look = a.Bernoulli(0.5) ? BlackPlastic() : BrushedSteel();
  for (int i = 0; i < dials; ++i) {
    // The dials are in two groups, left and right of the display.
    const int half = dials / 2, place_in_half = i % half;
    const double y = (i < half ? -1.0 : 1.0) * (0.20 + 0.12 * place_in_half) * across;
    AddDial(&a, "knob_" + std::to_string(i), body, {front, y, high - 0.5 * panel}, 0.020, 0.026,
            look);
  }
  return a.Finish("appliance");
}

}  // namespace simwright::library
