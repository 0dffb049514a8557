#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

// The dimensions in m, from retail basin and kitchen taps: bodies 40 to 55 mm thick, spouts 18 to
// 25 mm.
constexpr double kFaucetPlate = 0.008;

struct Tap {
  double reach, high, body_high, body_radius, spout_radius;
};

// Adds a spout that rises from the body's top, bends over in a half circle and ends slightly
// downwards.
void AddSpout(Assembly* a, int link, const Tap& t, double x, const Matter& metal) {
  const double foot = t.body_high + 0.001, bend = 0.5 * t.reach;
  const double rise = std::max(foot + 0.02, t.high - bend - t.spout_radius);
  std::vector<Eigen::Vector3d> path{{x, 0.0, foot}};
  for (const Eigen::Vector3d& p :
       Arc({x - bend, 0.0, rise}, {x, 0.0, rise}, -Eigen::Vector3d::UnitY(), M_PI, 10)) {
    path.push_back(p);
  }
  path.push_back(path.back() - Eigen::Vector3d(0, 0, 0.03));
  a->Add(link, metal, Pipe(path, t.spout_radius, 16));
}

void AddLever(Assembly* a, int body, const Tap& t, double x, const Matter& metal) {
  // The lever is on the body's side (+y) and rotates up about x.
  const double z = 0.72 * t.body_high;
  const Eigen::Vector3d hub(x, t.body_radius + 0.001, z);
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = hub;
  plan.axis = Eigen::Vector3d::UnitY();
  plan.upper = a->Draw(0.5, 0.9);
  plan.joint_resistance = SampleJointResistance(a->draws(), 0.08);
  const int lever = a->AddLink("lever", "lever", body, plan);
  const Eigen::Vector3d end = hub + Eigen::Vector3d(0.0, 0.028, 0.0);
  a->Add(lever, metal, Rod(hub, end, 0.017));
  // The grip points forwards and rotates upwards.
  a->Add(lever, metal,
         Box(end + Eigen::Vector3d(-0.105, 0.0, -0.006), end + Eigen::Vector3d(0.008, 0.012, 0.006),
             0.003));
}

void AddKnobs(Assembly* a, int body, const Tap& t, double x, double apart, const Matter& metal) {
  for (int i = 0; i < 2; ++i) {
    const double y = (i == 0 ? 1.0 : -1.0) * apart;
    const Eigen::Vector3d foot(x, y, kFaucetPlate);
    const double neck = kFaucetPlate + 0.45 * t.body_high;
    a->Add(body, metal, Frustum(foot, {x, y, neck}, 0.020, 0.014));
    JointPlan plan;
    plan.type = assets::JointType::kRevolute;
    plan.origin = {x, y, neck + 0.001};
    plan.axis = Eigen::Vector3d(0.0, 0.0, i == 0 ? 1.0 : -1.0);
    plan.upper = a->Draw(1.4, 3.0);
    plan.joint_resistance = SampleJointResistance(a->draws(), 0.022);
    const int knob = a->AddLink("knob_" + std::to_string(i), "knob", body, plan);
    a->Add(knob, metal, Rod(plan.origin, plan.origin + Eigen::Vector3d(0, 0, 0.014), 0.010));
    const Eigen::Vector3d middle = plan.origin + Eigen::Vector3d(0, 0, 0.014);
    // Two wings make a cross handle.
    a->Add(knob, metal,
           Box(middle - Eigen::Vector3d(0.007, 0.026, 0.0),
               middle + Eigen::Vector3d(0.007, 0.026, 0.014), 0.003));
  }
}

}  // namespace

assets::ArticulatedAsset MakeFaucet(const Options& options) {
  Assembly a("faucet", "faucet", options);
  a.FixToWorld();
  Tap t;
  t.reach = std::clamp(a.parameters().length.sample - 0.05, 0.11, 0.22);
  t.high = std::clamp(a.parameters().height.sample, 0.17, 0.40);
  t.body_high = a.Draw(0.07, 0.11);
  t.body_radius = a.Draw(0.020, 0.025);
  t.spout_radius = a.Draw(0.009, 0.012);
  const bool single = a.Bernoulli(0.6), swivel = a.Bernoulli(0.5);
  a.RecordFeature("control", single ? "lever" : "two knobs");
  a.RecordFeature("spout", swivel ? "swivels" : "fixed");
  const Matter metal = MatterOf("brass", "chrome", 0.80f, 0.82f, 0.84f);
  const int body = a.AddRoot("body", "body");
  const double apart = 0.10, x = 0.0;
  if (single) {
    a.Add(body, metal, Rod({x, 0, 0}, {x, 0, kFaucetPlate}, t.body_radius + 0.006, 28));
  } else {
    a.Add(body, metal,
          Box({x - 0.028, -apart - 0.028, 0.0}, {x + 0.028, apart + 0.028, kFaucetPlate}));
  }
  a.Add(body, metal,
        Frustum({x, 0, kFaucetPlate}, {x, 0, t.body_high}, t.body_radius,
                single ? t.body_radius : 0.8 * t.body_radius, 28));
  JointPlan plan;
  plan.origin = {x, 0.0, t.body_high};
  if (swivel) {
    plan.type = assets::JointType::kRevolute;
    plan.upper = a.Draw(0.8, 1.2);
    // The spout swivels away from a lever, whose range is the other half.
    plan.lower = single ? 0.0 : -plan.upper;
    plan.joint_resistance = SampleJointResistance(a.draws(), t.reach);
  }
  const int spout = a.AddLink("spout", "spout", body, plan);
  AddSpout(&a, spout, t, x, metal);
  if (single) {
    AddLever(&a, body, t, x, metal);
  } else {
    AddKnobs(&a, body, t, x, apart, metal);
  }
  return a.Finish("brass");
}

}  // namespace simwright::library
