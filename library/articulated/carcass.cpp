#include "library/articulated/carcass.h"

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kDialGap = 0.001;       // m, between a dial and its panel
constexpr double kDialRange = 4.7;       // rad, 270 degrees
constexpr double kButtonTravel = 0.003;  // m
constexpr double kButtonRaise = 0.004;   // m, the distance of the button's back from its panel

}  // namespace

Eigen::AlignedBox3d Bounds(double x0, double x1, double y0, double y1, double z0, double z1) {
  return {Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1)};
}

std::vector<core::TriangleMesh> CarcassPanels(const Eigen::AlignedBox3d& o, double wall) {
  const Eigen::Vector3d a = o.min(), b = o.max();
  const double low = a.z() + wall, high = b.z() - wall;
  return {Box(a, {b.x(), b.y(), low}), Box({a.x(), a.y(), high}, b),
          Box({a.x(), a.y(), low}, {b.x(), a.y() + wall, high}, 0.0),
          Box({a.x(), b.y() - wall, low}, {b.x(), b.y(), high}, 0.0),
          Box({b.x() - wall, a.y() + wall, low}, {b.x(), b.y() - wall, high}, 0.0)};
}

std::vector<core::TriangleMesh> FrameBars(const Eigen::AlignedBox3d& o, double border) {
  const Eigen::Vector3d a = o.min(), b = o.max();
  const double low = a.z() + border, high = b.z() - border;
  return {Box(a, {b.x(), b.y(), low}), Box({a.x(), a.y(), high}, b),
          Box({a.x(), a.y(), low}, {b.x(), a.y() + border, high}, 0.0),
          Box({a.x(), b.y() - border, low}, {b.x(), b.y(), high}, 0.0)};
}

core::TriangleMesh Pane(const Eigen::AlignedBox3d& o, double border, double thickness) {
  const Eigen::Vector3d center = o.center();
  Eigen::Vector3d half = 0.5 * o.sizes() - Eigen::Vector3d(0.0, border, border);
  half.x() = 0.5 * thickness;
  return Box(center - half, center + half, 0.0);
}

JointPlan SideHinge(double x, double y, double z, double upper, const JointResistance& feel) {
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = {x, y, z};
  plan.axis = Eigen::Vector3d(0.0, 0.0, y > 0.0 ? -1.0 : 1.0);
  plan.upper = upper;
  plan.joint_resistance = feel;
  return plan;
}

JointPlan BottomHinge(double x, double z, double upper, const JointResistance& feel) {
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = {x, 0.0, z};
  plan.axis = -Eigen::Vector3d::UnitY();
  plan.upper = upper;
  plan.joint_resistance = feel;
  return plan;
}

int AddDial(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
            double radius, double depth, const Matter& matter) {
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = mount;
  plan.axis = Eigen::Vector3d::UnitX();
  plan.upper = kDialRange;
  plan.joint_resistance = SampleJointResistance(assembly->draws(), radius);
  const int dial = assembly->AddLink(name, "knob", parent, plan);
  const Eigen::Vector3d out = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d foot = mount + kDialGap * out, top = mount + depth * out;
  assembly->Add(dial, matter, Frustum(foot, top, radius, 0.88 * radius, 24));
  const Eigen::Vector3d pointer(-0.0006, 0.0015, 0.0);
  assembly->Paint(dial, MatterOf("plastic", "white_print", 0.95f, 0.95f, 0.95f),
                  Box(top - pointer + Eigen::Vector3d(0, 0, 0.25 * radius),
                      top + pointer + Eigen::Vector3d(0, 0, 0.8 * radius), 0.0));
  return dial;
}

int AddButton(Assembly* assembly, const std::string& name, int parent, const Eigen::Vector3d& mount,
              double width, double height, const Matter& matter) {
  JointPlan plan;
  plan.type = assets::JointType::kPrismatic;
  plan.origin = mount;
  plan.axis = Eigen::Vector3d::UnitX();
  plan.upper = kButtonTravel;
  plan.joint_resistance = SampleJointResistance(assembly->draws());
  const int button = assembly->AddLink(name, "button", parent, plan);
  assembly->Add(button, matter,
                Box(mount + Eigen::Vector3d(-kButtonRaise - 0.005, -0.5 * width, -0.5 * height),
                    mount + Eigen::Vector3d(-kButtonRaise, 0.5 * width, 0.5 * height)));
  return button;
}

}  // namespace simwright::library
