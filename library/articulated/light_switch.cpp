#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

constexpr double kLightSwitchPlate = 0.010;  // m, thickness
constexpr double kSlack = 0.0012;            // m, between a rocker and the plate
constexpr double kTilt = 0.10;               // rad, of a rocker to either side
constexpr double kThrow = 0.45;              // rad, of a toggle to either side

// Returns the parameters of standard wall plates: 80 mm in Europe (DIN 49073 boxes), 86 mm (BS
// 4662), 70 x 114 mm (NEMA WD 6); each further gang adds 46 to 71 mm. The knowledge base has no row
// for them.
physics_params::PhysicalParameters SwitchParameters() {
  const std::string source = "standard wall plates, 70 to 157 mm";
  physics_params::PhysicalParameters p;
  p.category = "light switch";
  p.material = "plastic";
  p.length = {0.070, 0.157, 0.080, source};
  p.width = {0.008, 0.030, kLightSwitchPlate, source};
  p.height = {0.080, 0.120, 0.080, source};
  p.mass = {0.03, 0.45, 0.12, "plastic plates and switches by their volume"};
  const physics_params::Material& plastic =
      *physics_params::KnowledgeBase::Shipped().FindMaterial("plastic");
  const auto middle = [&](const physics_params::Interval& range) {
    return physics_params::Estimate{range.min, range.max, 0.5 * (range.min + range.max),
                                    plastic.source};
  };
  p.density = middle(plastic.density);
  p.friction = middle(plastic.friction);
  p.restitution = middle(plastic.restitution);
  return p;
}

// Adds a plate with an opening for each switch: bars around and between.
void AddPlate(Assembly* a, int body, double across, double high, int gangs, double wide,
              double tall, const Matter& plate) {
  const double x0 = -0.5 * kLightSwitchPlate, x1 = 0.5 * kLightSwitchPlate, y = 0.5 * across;
  const double low = 0.5 * (high - tall), top = 0.5 * (high + tall);
  a->Add(body, plate, Box({x0, -y, 0.0}, {x1, y, low}, 0.001));
  a->Add(body, plate, Box({x0, -y, top}, {x1, y, high}, 0.001));
  // The back, behind the tilting parts.
  a->Add(body, BlackPlastic(), Box({x1 + 0.003, -y, 0.0}, {x1 + 0.005, y, high}, 0.0));
  for (const double s : {-1.0, 1.0}) {
    a->Add(body, plate, Box({x1, s * y, 0.0}, {x1 + 0.003, s * (y - 0.002), high}, 0.0));
  }
  double from = -y;
  for (int i = 0; i < gangs; ++i) {
    const double middle = across * ((i + 0.5) / gangs - 0.5);
    a->Add(body, plate, Box({x0, from, low}, {x1, middle - 0.5 * wide, top}, 0.0004));
    from = middle + 0.5 * wide;
  }
  a->Add(body, plate, Box({x0, from, low}, {x1, y, top}, 0.0004));
}

// Returns the mesh rotated about y by `angle` at `pivot`, the centre of the opening.
core::TriangleMesh Tilted(core::TriangleMesh mesh, const Eigen::Vector3d& pivot, double angle) {
  core::Transform(Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) *
                      Eigen::Translation3d(-pivot) * Eigen::Affine3d::Identity(),
                  &mesh);
  return mesh;
}

}  // namespace

assets::ArticulatedAsset MakeLightSwitch(const Options& options) {
  Assembly a("light_switch", SwitchParameters(), options);
  a.FixToWorld();
  const bool toggle = a.Bernoulli(0.35);
  const int gangs = a.Bernoulli(0.4) ? 2 : 1;
  const double high = toggle ? 0.114 : a.Draw(0.080, 0.090);
  const double across = (toggle ? 0.070 : high) + (gangs - 1) * a.Draw(0.046, 0.060);
  a.parameters().length.sample = across;
  a.parameters().height.sample = high;
  a.RecordFeature("switch", toggle ? "toggle" : "rocker");
  const Matter plate = a.Bernoulli(0.8) ? MatterOf("plastic", "white_plastic", 0.93f, 0.93f, 0.90f)
                                        : MatterOf("plastic", "ivory_plastic", 0.88f, 0.82f, 0.68f);
  Matter knob = plate;
  knob.look = "switch_" + plate.look;
  knob.color.head<3>() *= 0.93f;
  const double wide = toggle ? 0.011 : (across / gangs) * 0.72, tall = toggle ? 0.026 : 0.72 * high;
  const int body = a.AddRoot("body", "body");
  AddPlate(&a, body, across, high, gangs, wide, tall, plate);
  for (int i = 0; i < gangs; ++i) {
    const double tilt = toggle ? kThrow : kTilt;
    const Eigen::Vector3d pivot(0.0, across * ((i + 0.5) / gangs - 0.5), 0.5 * high);
    JointPlan plan;
    plan.type = assets::JointType::kRevolute;
    plan.origin = pivot;
    plan.axis = Eigen::Vector3d::UnitY();
    plan.upper = 2.0 * tilt;
    plan.joint_resistance = SampleJointResistance(a.draws(), toggle ? 0.015 : 0.4 * tall);
    const std::string name = gangs > 1 ? "switch_" + std::to_string(i) : "switch";
    const int link = a.AddLink(name, "switch", body, plan);
    // The switch is modelled at mid-throw, then rotated back to "off".
    const double half = toggle ? 0.004 : 0.5 * wide - kSlack;
    const Eigen::Vector3d low =
        pivot + (toggle ? Eigen::Vector3d(-0.022, -half, -0.004)
                        : Eigen::Vector3d(-0.008, -half, -0.5 * tall + 2 * kSlack));
    const Eigen::Vector3d up =
        pivot + (toggle ? Eigen::Vector3d(0.003, half, 0.004)
                        : Eigen::Vector3d(0.003, half, 0.5 * tall - 2 * kSlack));
    a.Add(link, knob, Tilted(Box(low, up, 0.0015), pivot, -tilt));
  }
  return a.Finish();
}

}  // namespace simwright::library
