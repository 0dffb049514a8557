#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kDishwasherDoor = 0.045;   // m, thickness
constexpr double kDishwasherWall = 0.025;   // m
constexpr double kDishwasherPlinth = 0.14;  // m: keeps the open door and its handle above the floor
constexpr double kPanel = 0.075;            // m, height of the control panel

}  // namespace

assets::ArticulatedAsset MakeDishwasher(const Options& options) {
  Assembly a("dishwasher", "dishwasher", options);
  const double across = a.parameters().length.sample, deep = a.parameters().width.sample;
  const double high = a.parameters().height.sample;
  const double front = -0.5 * deep, rear = 0.5 * deep, inner = front + kDishwasherDoor + kGap;
  const Matter casing = Casing(a.draws());
  const int body = a.AddRoot("body", "body");
  // The pump and the counterweight are in the plinth.
  a.Add(body, BlackPlastic(),
        Box({inner + 0.04, -0.48 * across, 0.0}, {inner + 0.05, 0.48 * across, kDishwasherPlinth},
            0.0));
  a.Add(body, casing,
        Box({inner + 0.05, -0.5 * across, 0.0}, {rear, 0.5 * across, kDishwasherPlinth}));
  const double shell_top = high - kPanel;
  a.Add(
      body, casing,
      CarcassPanels(Bounds(inner, rear, -0.5 * across, 0.5 * across, kDishwasherPlinth, shell_top),
                    kDishwasherWall));
  a.Add(body, casing, Box({front, -0.5 * across, shell_top}, {rear, 0.5 * across, high}));
  // The two wire baskets are modelled as trays.
  for (const double share : {0.12, 0.55}) {
    const double z = kDishwasherPlinth + kDishwasherWall +
                     share * (shell_top - kDishwasherPlinth - 2 * kDishwasherWall);
    a.Add(body, BrushedSteel(),
          Box({inner + 0.03, -0.5 * across + kDishwasherWall, z},
              {rear - kDishwasherWall, 0.5 * across - kDishwasherWall, z + 0.002}, 0.0));
  }
  a.Paint(body, DarkGlass(),
          Box({front - 0.0008, 0.10 * across, high - 0.75 * kPanel},
              {front + 0.001, 0.32 * across, high - 0.3 * kPanel}, 0.0));

  const double top = shell_top - kGap;
  const int door =
      a.AddLink("door", "door", body,
                BottomHinge(front + kDishwasherDoor, kDishwasherPlinth, a.Draw(1.45, 1.55),
                            SampleJointResistance(a.draws(), top - kDishwasherPlinth)));
  a.Add(
      door, casing,
      Box({front, -0.5 * across, kDishwasherPlinth}, {front + kDishwasherDoor, 0.5 * across, top}));
  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  HandlePlacement place;
  place.mount = {front, 0.0, top - 0.05};
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitY();
  place.length = a.Draw(0.45, 0.8) * across;
  place.standoff = a.Draw(0.036, 0.044);
  a.AddHandle("handle_0", door, kind, place, BrushedSteel());

  const int buttons = 2 + static_cast<int>(a.Draw(0.0, 2.999));
  for (int i = 0; i < buttons; ++i) {
    AddButton(&a, "button_" + std::to_string(i), body,
              {front, (-0.40 + 0.12 * i) * across, high - 0.5 * kPanel}, 0.05, 0.02,
              BlackPlastic());
  }
  return a.Finish("appliance");
}

}  // namespace simwright::library
