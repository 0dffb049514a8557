#include "scene/feasibility/lowering.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "scene/feasibility/narrow_phase.h"

namespace simwright::scene {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kContactDistance = 1e-5;   // m between two parts in contact
constexpr double kSupportingNormal = 0.02;  // z of a contact normal: steeper faces do not support
constexpr int kMostTangents = 100;          // per pair of parts; flat faces take one

class Lowering {
 public:
  explicit Lowering(const std::vector<ProjectedBody>& bodies)
      : shifts_(bodies.size(), Vector3d::Zero()) {
    for (const ProjectedBody& body : bodies) {
      bodies_.Add(*body.parts, body.world_from_body, body.fixed);
    }
  }

  std::vector<Vector3d> Run(double most) {
    std::vector<int> order(shifts_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
      return bodies_.Box(i, -1).min().z() < bodies_.Box(j, -1).min().z();
    });
    for (const int body : order) {
      if (bodies_.fixed(body)) continue;
      const double clearance = ClearanceBeneath(body, most);
      if (clearance < most) shifts_[static_cast<size_t>(body)].z() = -clearance;
    }
    return shifts_;
  }

 private:
  // Returns how far the body can move down, m, `most` if there is at least that much space.
  double ClearanceBeneath(int body, double most) const {
    double clearance = std::clamp(bodies_.Box(body, -1).min().z(), 0.0, most);
    for (int other = 0; other < bodies_.size(); ++other) {
      if (other == body || !IsUnder(other, -1, body, -1, clearance)) continue;
      for (int p = 0; p < bodies_.Parts(other); ++p) {
        if (!IsUnder(other, p, body, -1, clearance)) continue;
        for (int q = 0; q < bodies_.Parts(body); ++q) {
          if (IsUnder(other, p, body, q, clearance))
            clearance = DistanceToContact(other, p, body, q, clearance);
        }
      }
    }
    return clearance;
  }

  // Returns true if the AABB of a part of `body`, swept down by `clearance`, intersects that of a
  // part of `other`.
  bool IsUnder(int other, int other_part, int body, int part, double clearance) const {
    AlignedBox3d swept = bodies_.Box(body, part);
    swept.min().z() -= clearance;
    AlignedBox3d under = bodies_.Box(other, other_part);
    under.translate(shifts_[static_cast<size_t>(other)]);
    return swept.intersects(under);
  }

  // Returns the downward distance to contact of two parts, m, no more than `clearance`.
  double DistanceToContact(int other, int other_part, int body, int part, double clearance) const {
    double travelled = 0.0;
    for (int i = 0; i < kMostTangents && travelled < clearance; ++i) {
      const Vector3d apart = -travelled * Vector3d::UnitZ() - shifts_[static_cast<size_t>(other)];
      const NarrowPhasePair near = bodies_.Distance(other, other_part, body, part, apart);
      if (near.normal.z() < kSupportingNormal) return clearance;
      if (near.distance <= kContactDistance) return travelled;
      travelled += near.distance / near.normal.z();
    }
    return std::min(travelled, clearance);
  }

  ConvexBodies bodies_;
  std::vector<Vector3d> shifts_;
};

}  // namespace

std::vector<Vector3d> LowerOntoSupports(const std::vector<ProjectedBody>& bodies, double most) {
  if (!(most >= 0.0)) throw core::Error("objects are lowered by 0 m or more");
  return Lowering(bodies).Run(most);
}

}  // namespace simwright::scene
