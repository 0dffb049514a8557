#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kMicrowaveFoot = 0.012;  // m, height of the feet
constexpr double kMicrowaveDoor = 0.030;  // m, thickness
constexpr double kMicrowaveWall = 0.022;  // m

struct MicrowavePlan {
  double deep, across, high;  // m
  double side;                // +1: the hinge is at +y, the panel at -y; -1: mirrored
  double panel;               // m, width of the panel
  double split;               // |y| where door and panel meet, on the panel's side
};

void AddMicrowaveFeet(Assembly* a, int body, const MicrowavePlan& p) {
  for (const double x : {-0.38, 0.38}) {
    for (const double y : {-0.42, 0.42}) {
      const Eigen::Vector3d foot(x * p.deep, y * p.across, 0.0);
      a->Add(body, BlackPlastic(),
             Rod(foot, foot + Eigen::Vector3d(0, 0, kMicrowaveFoot), 0.014, 12));
    }
  }
}

void AddBody(Assembly* a, int body, const MicrowavePlan& p, const Matter& casing) {
  const double front = -0.5 * p.deep, rear = 0.5 * p.deep, inner = front + kMicrowaveDoor + kGap;
  const double y_panel = -p.side * 0.5 * p.across, y_split = -p.side * p.split;
  // The panel's side is solid with electronics and extends to the front.
  a->Add(body, casing, Box({front, y_panel, kMicrowaveFoot}, {rear, y_split, p.high}));
  const double y0 = std::min(y_split, p.side * 0.5 * p.across);
  const double y1 = std::max(y_split, p.side * 0.5 * p.across);
  a->Add(body, casing,
         CarcassPanels(Bounds(inner, rear, y0, y1, kMicrowaveFoot, p.high), kMicrowaveWall));
  AddMicrowaveFeet(a, body, p);
  const Eigen::Vector3d plate(0.5 * (inner + rear), 0.5 * (y0 + y1),
                              kMicrowaveFoot + kMicrowaveWall);
  const double radius = 0.38 * std::min(rear - inner, y1 - y0);
  a->Add(body, ClearGlass(), Rod(plate, plate + Eigen::Vector3d(0, 0, 0.008), radius, 28));
  const double display = 0.5 * (y_panel + y_split);
  a->Paint(body, DarkGlass(),
           Box({front - 0.0008, display - 0.36 * p.panel, 0.80 * p.high},
               {front + 0.001, display + 0.36 * p.panel, 0.92 * p.high}, 0.0));
}

void AddControls(Assembly* a, int body, const MicrowavePlan& p) {
  const double front = -0.5 * p.deep;
  const double middle = -p.side * 0.5 * (p.split + 0.5 * p.across);
  const Matter look = a->Bernoulli(0.5) ? BlackPlastic() : BrushedSteel();
  if (a->Bernoulli(0.5)) {
    a->RecordFeature("controls", "dials");
    for (int i = 0; i < 2; ++i) {
      AddDial(a, "knob_" + std::to_string(i), body, {front, middle, (0.60 - 0.30 * i) * p.high},
              0.22 * p.panel, 0.022, look);
    }
    return;
  }
  a->RecordFeature("controls", "buttons");
  for (int i = 0; i < 6; ++i) {
    AddButton(a, "button_" + std::to_string(i), body,
              {front, middle + (i % 2 - 0.5) * 0.40 * p.panel, (0.66 - 0.19 * (i / 2)) * p.high},
              0.28 * p.panel, 0.10 * p.high, look);
  }
}

}  // namespace

assets::ArticulatedAsset MakeMicrowave(const Options& options) {
  Assembly a("microwave", "microwave", options);
  MicrowavePlan p;
  p.across = a.parameters().length.sample;
  p.deep = a.parameters().width.sample;
  p.high = a.parameters().height.sample;
  p.side = a.Bernoulli(0.85) ? 1.0 : -1.0;
  p.panel = a.Draw(0.20, 0.26) * p.across;
  p.split = 0.5 * p.across - p.panel;
  a.RecordFeature("hinge", p.side > 0.0 ? "left" : "right");
  const Matter casing = Casing(a.draws());
  const int body = a.AddRoot("body", "body");
  AddBody(&a, body, p, casing);

  const double front = -0.5 * p.deep, hinge_y = p.side * 0.5 * p.across;
  const double free_y = -p.side * (p.split - kGap);
  const double width = std::abs(hinge_y - free_y);
  const int door = a.AddLink("door", "door", body,
                             SideHinge(front + kMicrowaveDoor, hinge_y, 0.5 * p.high,
                                       a.Draw(1.6, 2.0), SampleJointResistance(a.draws(), width)));
  const Eigen::AlignedBox3d slab = Bounds(front, front + kMicrowaveDoor, std::min(hinge_y, free_y),
                                          std::max(hinge_y, free_y), kMicrowaveFoot + kGap, p.high);
  const double border = 0.16 * p.high;
  a.Add(door, casing, FrameBars(slab, border));
  a.Add(door, DarkGlass(), Pane(slab, border, 0.010));

  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  HandlePlacement place;
  place.mount = {front, free_y + p.side * 0.022, 0.5 * (p.high + kMicrowaveFoot)};
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitZ();
  place.length = a.Draw(0.55, 0.8) * p.high;
  place.standoff = a.Draw(0.034, 0.042);
  a.AddHandle("handle_0", door, kind, place, BrushedSteel());
  AddControls(&a, body, p);
  return a.Finish("appliance");
}

}  // namespace simwright::library
