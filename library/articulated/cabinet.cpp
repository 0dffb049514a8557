#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kCabinetBoard = 0.018;  // m

}  // namespace

assets::ArticulatedAsset MakeCabinet(const Options& options) {
  Assembly a("cabinet", "cabinet", options);
  a.FixToWorld();
  const double across = std::min(a.parameters().length.sample, 1.0);
  const double deep = std::min(a.parameters().width.sample, 0.6);
  const double high = a.parameters().height.sample;
  const double front = -0.5 * deep, rear = 0.5 * deep, inner = front + kCabinetBoard + kGap;
  const Matter board = Board(a.draws());
  const int body = a.AddRoot("body", "body");
  a.Add(body, board,
        CarcassPanels(Bounds(inner, rear, -0.5 * across, 0.5 * across, 0.0, high), kCabinetBoard));
  const int shelves = std::clamp(static_cast<int>(high / 0.35) - 1, 0, 5);
  for (int i = 1; i <= shelves; ++i) {
    const double z = high * i / (shelves + 1);
    a.Add(body, board,
          Box({inner + 0.01, -0.5 * across + kCabinetBoard, z},
              {rear - kCabinetBoard, 0.5 * across - kCabinetBoard, z + kCabinetBoard}, 0.0));
  }
  a.RecordFeature("shelves", std::to_string(shelves));
  const bool two = across > 0.55 || (across > 0.45 && a.Bernoulli(0.5));
  a.RecordFeature("doors", two ? "two" : "one");
  const HandleKind kind =
      SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow, HandleKind::kKnob});
  a.RecordFeature("handle", HandleName(kind));
  const Matter metal = FurnitureMetal(a.draws());
  const double upper = a.Draw(1.6, 2.3);
  const double first = a.Bernoulli(0.5) ? 1.0 : -1.0;
  if (!two) a.RecordFeature("hinge", first > 0.0 ? "left" : "right");
  for (int i = 0; i < (two ? 2 : 1); ++i) {
    const double side = i == 0 ? first : -first;
    const double hinge_y = side * 0.5 * across;
    const double free_y = two ? side * 0.5 * kGap : -side * 0.5 * across;
    const int door =
        a.AddLink(two ? "door_" + std::to_string(i) : "door", "door", body,
                  SideHinge(front + kCabinetBoard, hinge_y, 0.5 * high, upper,
                            SampleJointResistance(a.draws(), std::abs(hinge_y - free_y))));
    a.Add(door, board, Box({front, hinge_y, 0.0}, {front + kCabinetBoard, free_y, high}, 0.003));
    HandlePlacement place;
    place.mount = {front, free_y + side * 0.035, 0.5 * high};
    place.out = -Eigen::Vector3d::UnitX();
    place.along = Eigen::Vector3d::UnitZ();
    place.length = std::min(0.14, 0.5 * high);
    place.standoff = 0.036;
    a.AddHandle("handle_" + std::to_string(i), door, kind, place, metal);
  }
  return a.Finish("plywood");
}

}  // namespace simwright::library
