#include <algorithm>
#include <string>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr double kBar = 0.055;      // m, width of the outer frame's bars
constexpr double kSashBar = 0.045;  // m
constexpr double kSash = 0.034;     // m, thickness of a sash
constexpr double kGlass = 0.006;    // m: one pane; double glazing weighs as two of 3 mm

void AddSash(Assembly* a, int link, const Eigen::AlignedBox3d& box, const Matter& bars) {
  a->Add(link, bars, FrameBars(box, kSashBar));
  a->Add(link, ClearGlass(), Pane(box, kSashBar, kGlass));
}

void AddGrip(Assembly* a, int sash, HandleKind kind, const Eigen::Vector3d& mount,
             const Matter& metal) {
  HandlePlacement place;
  place.mount = mount;
  place.out = -Eigen::Vector3d::UnitX();
  place.along = Eigen::Vector3d::UnitZ();
  place.length = 0.12;
  place.standoff = 0.036;
  a->AddHandle("handle_0", sash, kind, place, metal);
}

// Adds two sashes one behind the other; the front one slides along y over the other.
void AddSliding(Assembly* a, int body, const Eigen::AlignedBox3d& hole, HandleKind kind,
                const Matter& bars, const Matter& metal) {
  const double middle = 0.5 * kSashBar, side = a->Bernoulli(0.5) ? 1.0 : -1.0;
  a->RecordFeature("moves", side > 0.0 ? "left sash" : "right sash");
  const double y_edge = side * (0.5 * hole.sizes().y() - kGap), y_meet = -side * middle;
  const double z0 = hole.min().z() + kGap, z1 = hole.max().z() - kGap;
  // The front track and the rear track.
  const double front = -kSash - 0.004, rear = 0.004;
  AddSash(a, body,
          Bounds(rear, rear + kSash, std::min(-side * 0.5 * hole.sizes().y(), -y_meet),
                 std::max(-side * 0.5 * hole.sizes().y(), -y_meet), hole.min().z(), hole.max().z()),
          bars);
  JointPlan plan;
  plan.type = assets::JointType::kPrismatic;
  plan.origin = {front, 0.5 * (y_edge + y_meet), 0.5 * (z0 + z1)};
  plan.axis = Eigen::Vector3d(0.0, -side, 0.0);
  plan.upper = 0.5 * hole.sizes().y() - middle - 4 * kGap;
  plan.joint_resistance = SampleJointResistance(a->draws());
  const int sash = a->AddLink("sash", "window", body, plan);
  AddSash(a, sash,
          Bounds(front, front + kSash, std::min(y_edge, y_meet), std::max(y_edge, y_meet), z0, z1),
          bars);
  AddGrip(a, sash, kind, {front, y_edge - side * 0.5 * kSashBar, 0.5 * (z0 + z1)}, metal);
}

// Adds a sash in front of the frame, on a side hinge.
void AddCasement(Assembly* a, int body, const Eigen::AlignedBox3d& hole, double front,
                 HandleKind kind, const Matter& bars, const Matter& metal) {
  const double side = a->Bernoulli(0.5) ? 1.0 : -1.0, lap = 0.018;
  a->RecordFeature("hinge", side > 0.0 ? "left" : "right");
  const double half = 0.5 * hole.sizes().y() + lap, x1 = front - kGap;
  const double z0 = hole.min().z() - lap, z1 = hole.max().z() + lap;
  const int sash = a->AddLink("sash", "window", body,
                              SideHinge(x1, side * half, 0.5 * (z0 + z1), a->Draw(1.2, 1.57),
                                        SampleJointResistance(a->draws(), 2 * half)));
  AddSash(a, sash, Bounds(x1 - kSash, x1, -half, half, z0, z1), bars);
  AddGrip(a, sash, kind, {x1 - kSash, -side * (half - 0.5 * kSashBar), 0.5 * (z0 + z1)}, metal);
}

}  // namespace

assets::ArticulatedAsset MakeWindow(const Options& options) {
  Assembly a("window", "window", options);
  a.FixToWorld();
  const bool sliding = a.Bernoulli(0.5);
  a.RecordFeature("opens", sliding ? "slides" : "swings");
  // A casement is at most 0.9 m wide, because wider ones sag: wider windows slide.
  const double across =
      std::clamp(a.parameters().length.sample, sliding ? 0.8 : 0.48, sliding ? 1.6 : 0.9);
  const double high = std::clamp(a.parameters().height.sample, 0.5, 1.4);
  const double half = 0.045;  // half of the frame's depth
  const Matter bars = a.Bernoulli(0.6) ? MatterOf("plastic", "white_frame", 0.93f, 0.93f, 0.91f)
                                       : MatterOf("wood", "oak", 0.72f, 0.53f, 0.34f);
  const int body = a.AddRoot("frame", "frame");
  a.Add(body, bars, FrameBars(Bounds(-half, half, -0.5 * across, 0.5 * across, 0.0, high), kBar));
  const Eigen::AlignedBox3d hole =
      Bounds(-half, half, -0.5 * across + kBar, 0.5 * across - kBar, kBar, high - kBar);
  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kBar, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  if (sliding) {
    AddSliding(&a, body, hole, kind, bars, BrushedSteel());
  } else {
    AddCasement(&a, body, hole, -half, kind, bars, BrushedSteel());
  }
  return a.Finish();
}

}  // namespace simwright::library
