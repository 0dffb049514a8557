#include <algorithm>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kLowestBox = 0.06;   // m, with its lid
constexpr double kBoxLidGap = 0.002;  // m, between the lid and the rim

}  // namespace

assets::ArticulatedAsset MakeBoxWithLid(const Options& options) {
  Assembly a("box_with_lid", "box", options);
  // The box is a table-top chest, although the row spans boxes from 14 to 110 cm.
  double across = a.Draw(0.22, 0.48), deep = a.Draw(0.6, 0.8) * across;
  double high = a.Draw(0.45, 0.75) * deep + 0.04;
  if (options.size) {
    across = options.size->x();
    deep = options.size->y();
    high = std::max(options.size->z(), kLowestBox);
  }
  a.parameters().length.sample = across;
  a.parameters().width.sample = deep;
  a.parameters().height.sample = high;
  const double wall = a.Draw(0.007, 0.010), lid_high = a.Draw(0.022, 0.034);
  const double rim = high - lid_high;
  const bool wooden = a.Bernoulli(0.6);
  const Matter side =
      wooden ? Board(a.draws()) : MatterOf("plastic", "blue_plastic", 0.25f, 0.42f, 0.66f);
  const double x = 0.5 * deep, y = 0.5 * across;
  const int body = a.AddRoot("body", "body");
  const double top = rim - kBoxLidGap;
  a.Add(body, side, Box({-x, -y, 0.0}, {x, y, wall}));
  a.Add(body, side, Box({-x, -y, wall}, {-x + wall, y, top}, 0.001));
  a.Add(body, side, Box({x - wall, -y, wall}, {x, y, top}, 0.001));
  a.Add(body, side, Box({-x + wall, -y, wall}, {x - wall, -y + wall, top}, 0.0));
  a.Add(body, side, Box({-x + wall, y - wall, wall}, {x - wall, y, top}, 0.0));

  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = {x, 0.0, rim};
  plan.axis = Eigen::Vector3d::UnitY();
  plan.upper = a.Draw(1.4, 1.75);
  plan.joint_resistance = SampleJointResistance(a.draws(), deep);
  const int lid = a.AddLink("lid", "lid", body, plan);
  a.Add(lid, side, Box({-x, -y, high - wall}, {x, y, high}));
  a.Add(lid, side, Box({-x, -y, rim}, {-x + wall, y, high - wall}, 0.001));
  a.Add(lid, side, Box({x - wall, -y, rim}, {x, y, high - wall}, 0.001));
  a.Add(lid, side, Box({-x + wall, -y, rim}, {x - wall, -y + wall, high - wall}, 0.0));
  a.Add(lid, side, Box({-x + wall, y - wall, rim}, {x - wall, y, high - wall}, 0.0));

  const HandleKind kind =
      SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow, HandleKind::kKnob});
  a.RecordFeature("handle", HandleName(kind));
  HandlePlacement place;
  place.mount = {-x + 0.045, 0.0, high};
  place.out = Eigen::Vector3d::UnitZ();
  place.along = Eigen::Vector3d::UnitY();
  place.length = 0.11;
  place.standoff = 0.034;
  a.AddHandle("handle_0", lid, kind, place, FurnitureMetal(a.draws()));
  return a.Finish(side.material);
}

}  // namespace simwright::library
