#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kLeaf = 0.040;        // m, thickness of the leaf
constexpr double kJamb = 0.045;        // m, width of the frame's bars
constexpr double kStop = 0.012;        // m, overlap of the stop over the leaf
constexpr double kFloorGap = 0.008;    // m, under the leaf
constexpr double kHandleHeight = 1.0;  // m; 0.86 to 1.22 by ADA Standards 2010, 404.2.7
constexpr double kBackset = 0.065;     // m, from the leaf's edge to the spindle
constexpr double kTurn = 0.75;         // rad, of a lever or knob

// Adds a lever or a knob on one face of the leaf; it rotates about the spindle.
void AddTurningHandle(Assembly* a, int leaf, int index, const Eigen::Vector3d& mount,
                      const Eigen::Vector3d& out, double side, bool lever, const Matter& metal) {
  a->Add(leaf, metal, Rod(mount, mount + 0.008 * out, 0.026));
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = mount + 0.05 * out;
  // Rotation presses the lever's end down, in either direction of the lever.
  plan.axis = Eigen::Vector3d(side, 0.0, 0.0);
  plan.upper = kTurn;
  plan.joint_resistance = SampleJointResistance(a->draws(), lever ? 0.1 : 0.026);
  const int handle = a->AddLink("handle_" + std::to_string(index), "handle", leaf, plan);
  const Eigen::Vector3d foot = mount + 0.009 * out, head = mount + 0.056 * out;
  if (lever) {
    a->Add(handle, metal, Rod(foot, head, 0.009));
    const Eigen::Vector3d towards(0.0, side, 0.0);
    const Eigen::Vector3d from = head + 0.009 * towards - 0.009 * out;
    a->Add(handle, metal,
           Box(from - 0.007 * out - Eigen::Vector3d(0, 0, 0.009),
               from + 0.115 * towards + 0.007 * out + Eigen::Vector3d(0, 0, 0.009), 0.004));
  } else {
    a->Add(handle, metal, Frustum(foot, mount + 0.03 * out, 0.010, 0.012));
    a->Add(handle, metal, Frustum(mount + 0.03 * out, mount + 0.045 * out, 0.018, 0.027));
    a->Add(handle, metal, Frustum(mount + 0.045 * out, mount + 0.065 * out, 0.027, 0.020));
  }
}

void AddFrame(Assembly* a, int frame, double deep, double across, double high, const Matter& wood) {
  const double x = 0.5 * deep, y = 0.5 * across;
  const double stop = -x + kLeaf + kGap;  // the leaf closes against it
  for (const double s : {-1.0, 1.0}) {
    a->Add(frame, wood, Box({-x, s * y, 0.0}, {x, s * (y - kJamb), high - kJamb}, 0.003));
    a->Add(frame, wood,
           Box({stop, s * (y - kJamb), 0.0}, {x, s * (y - kJamb - kStop), high - kJamb}, 0.0));
  }
  a->Add(frame, wood, Box({-x, -y, high - kJamb}, {x, y, high}, 0.003));
  const double inner = y - kJamb - kStop;
  a->Add(frame, wood, Box({stop, -inner, high - kJamb - kStop}, {x, inner, high - kJamb}, 0.0));
}

}  // namespace

assets::ArticulatedAsset MakeDoor(const Options& options) {
  Assembly a("door", "door", options);
  a.FixToWorld();
  const double across = a.parameters().length.sample;
  const double deep = std::clamp(a.parameters().width.sample, 0.09, 0.16);
  const double high = a.parameters().height.sample;
  const Matter frame_wood = Board(a.draws()), leaf_wood = Board(a.draws());
  const int frame = a.AddRoot("frame", "frame");
  AddFrame(&a, frame, deep, across, high, frame_wood);

  const double side = a.Bernoulli(0.5) ? 1.0 : -1.0;
  a.RecordFeature("hinge", side > 0.0 ? "left" : "right");
  const double front = -0.5 * deep, edge = 0.5 * across - kJamb - kGap;
  const int leaf = a.AddLink("door", "door", frame,
                             SideHinge(front, side * edge, 0.5 * high, a.Draw(1.5, 1.9),
                                       SampleJointResistance(a.draws(), across)));
  const double top = high - kJamb - kGap;
  a.Add(leaf, leaf_wood, Box({front, -edge, kFloorGap}, {front + kLeaf, edge, top}, 0.002));
  // The panels are mouldings a shade darker.
  Matter shade = leaf_wood;
  shade.look += "_moulding";
  shade.color.head<3>() *= 0.82f;
  const int panels = 1 + static_cast<int>(a.Draw(0.0, 2.999));
  for (int i = 0; i < panels; ++i) {
    const double low = kFloorGap + 0.12 + (top - 0.20) * i / panels;
    const double up = kFloorGap + 0.02 + (top - 0.20) * (i + 1) / panels;
    a.Paint(leaf, shade,
            Box({front - 0.0008, -edge + 0.14, low}, {front + 0.001, edge - 0.14, up}, 0.0));
  }
  a.RecordFeature("panels", std::to_string(panels));
  const bool lever = a.Bernoulli(0.65);
  a.RecordFeature("handle", lever ? "lever" : "knob");
  const Matter metal = FurnitureMetal(a.draws());
  const double spindle = -side * (edge - kBackset);
  AddTurningHandle(&a, leaf, 0, {front, spindle, kHandleHeight}, -Eigen::Vector3d::UnitX(), side,
                   lever, metal);
  AddTurningHandle(&a, leaf, 1, {front + kLeaf, spindle, kHandleHeight}, Eigen::Vector3d::UnitX(),
                   side, lever, metal);
  return a.Finish("plywood");
}

}  // namespace simwright::library
