#include <algorithm>
#include <cmath>

#include "library/articulated/articulated_kinds.h"
#include "library/articulated/carcass.h"
#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

constexpr int kStaves = 16;                // number of straight walls around the can
constexpr double kTrashCanLidGap = 0.003;  // m
constexpr double kLid = 0.012;             // m, thickness
constexpr double kOverhang = 0.006;        // m, of the lid over the rim

// Returns a wall of staves between two circles; each is a wedge, so that neighbours share their
// sides.
std::vector<core::TriangleMesh> RoundWall(double low_radius, double high_radius, double wall,
                                          double low, double high) {
  std::vector<core::TriangleMesh> staves;
  for (int i = 0; i < kStaves; ++i) {
    std::vector<Eigen::Vector3d> points;
    for (const double angle : {2.0 * M_PI * i / kStaves, 2.0 * M_PI * (i + 1) / kStaves}) {
      const Eigen::Vector3d spoke(std::cos(angle), std::sin(angle), 0.0);
      for (const double in : {0.0, wall}) {
        points.push_back((low_radius - in) * spoke + Eigen::Vector3d(0, 0, low));
        points.push_back((high_radius - in) * spoke + Eigen::Vector3d(0, 0, high));
      }
    }
    staves.push_back(Hull(points));
  }
  return staves;
}

}  // namespace

assets::ArticulatedAsset MakeTrashCan(const Options& options) {
  Assembly a("trash_can", "trash can", options);
  const double width = std::clamp(a.parameters().width.sample, 0.20, 0.42);
  const double high = std::max(a.parameters().height.sample, 1.1 * width);
  const double top_radius = 0.5 * width, low_radius = a.Draw(0.8, 0.95) * top_radius;
  const double wall = 0.004, rim = high - kLid - kTrashCanLidGap;
  const Matter shell =
      a.Bernoulli(0.5) ? BrushedSteel() : MatterOf("plastic", "green_plastic", 0.30f, 0.45f, 0.36f);
  // Steel sheet is 0.6 mm thick: walls are modelled 4 mm thick with the sheet's mass.
  Matter thin = shell;
  if (shell.material == "steel") thin.density *= 0.15;
  const int body = a.AddRoot("body", "body");
  a.Add(body, thin, Rod({0, 0, 0}, {0, 0, 0.01}, low_radius, kStaves));
  a.Add(body, thin, RoundWall(low_radius, top_radius, wall, 0.01, rim));
  JointPlan plan;
  plan.type = assets::JointType::kRevolute;
  plan.origin = {top_radius + kOverhang, 0.0, rim + kTrashCanLidGap};
  plan.axis = Eigen::Vector3d::UnitY();
  plan.upper = a.Draw(1.3, 1.7);
  plan.joint_resistance = SampleJointResistance(a.draws(), width);
  const int lid = a.AddLink("lid", "lid", body, plan);
  const double bottom = rim + kTrashCanLidGap;
  Matter cover = BlackPlastic();
  a.Add(lid, cover,
        Frustum({0, 0, bottom}, {0, 0, bottom + kLid}, top_radius + kOverhang, top_radius - 0.01,
                28));
  const HandleKind kind = SampleHandleKind(a.draws(), {HandleKind::kKnob, HandleKind::kBow});
  a.RecordFeature("handle", HandleName(kind));
  HandlePlacement place;
  place.mount = {-0.5 * top_radius, 0.0, bottom + kLid};
  place.out = Eigen::Vector3d::UnitZ();
  place.along = Eigen::Vector3d::UnitY();
  place.length = std::min(0.11, top_radius);
  place.standoff = 0.032;
  a.AddHandle("handle_0", lid, kind, place, BrushedSteel());
  return a.Finish();
}

}  // namespace simwright::library
