#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kToasterFoot = 0.010;  // m
constexpr double kFloor = 0.030;        // m, of the body, with its heaters' wiring
constexpr double kSlot = 0.032;         // m, wide: for a thick slice
constexpr double kEnd = 0.035;          // m, thickness of the ends
constexpr double kLeverGap = 0.003;     // m, between the lever and the front

}  // namespace

assets::ArticulatedAsset MakeToaster(const Options& options) {
  Assembly a("toaster", "toaster", options);
  // The long side lies along x, so that the lever's end faces a user at negative x.
  const double lever_deep = 0.028;
  const double deep = a.parameters().length.sample - lever_deep;
  const double across = std::max(a.parameters().width.sample, 2 * kSlot + 0.06);
  const double high = a.parameters().height.sample;
  const double x0 = -0.5 * deep, x1 = 0.5 * deep, y = 0.5 * across, low = kToasterFoot + kFloor;
  const Matter casing = Casing(a.draws());
  const int body = a.AddRoot("body", "body");
  for (const double fx : {-0.4, 0.4}) {
    for (const double fy : {-0.35, 0.35}) {
      a.Add(body, BlackPlastic(),
            Rod({fx * deep, fy * across, 0.0}, {fx * deep, fy * across, kToasterFoot}, 0.010, 12));
    }
  }
  a.Add(body, BlackPlastic(), Box({x0, -y, kToasterFoot}, {x1, y, low}, 0.004));
  a.Add(body, casing, Box({x0, -y, low}, {x0 + kEnd, y, high}, 0.008));
  a.Add(body, casing, Box({x1 - kEnd, -y, low}, {x1, y, high}, 0.008));
  const double wall = (across - 2 * kSlot) / 3.0;
  for (const double from : {-y, -0.5 * wall, y - wall}) {
    a.Add(body, casing, Box({x0 + kEnd, from, low}, {x1 - kEnd, from + wall, high - 0.004}, 0.003));
  }
  // The slit in which the lever slides.
  const double top = high - 0.045, travel = a.Draw(0.40, 0.48) * high;
  a.Paint(body, BlackPlastic(),
          Box({x0 - 0.0008, -0.005, top - travel - 0.01}, {x0 + 0.001, 0.005, top + 0.01}, 0.0));

  JointPlan plan;
  plan.type = assets::JointType::kPrismatic;
  plan.origin = {x0 - kLeverGap, 0.0, top};
  plan.axis = -Eigen::Vector3d::UnitZ();
  plan.upper = travel;
  plan.joint_resistance = SampleJointResistance(a.draws());
  const int lever = a.AddLink("lever", "lever", body, plan);
  const double half = a.Draw(0.018, 0.024);
  a.Add(lever, BlackPlastic(),
        Box({x0 - kLeverGap - lever_deep, -half, top - 0.006}, {x0 - kLeverGap, half, top + 0.006},
            0.003));
  const double side = a.Bernoulli(0.5) ? 1.0 : -1.0;
  AddDial(&a, "knob", body, {x0, side * 0.34 * across, low + 0.035}, 0.013, 0.018, BrushedSteel());
  return a.Finish("appliance");
}

}  // namespace simwright::library
