#include "scene/lowering.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "scene/near_parts.h"

namespace simwright::scene {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kMeets = 1e-5;     // m between two parts that have met
constexpr double kHolds = 0.02;     // of a normal's z: what is steeper holds nothing
constexpr int kMostTangents = 100;  // of a pair of parts; flat faces take one

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
      const double room = RoomBeneath(body, most);
      if (room < most) shifts_[static_cast<size_t>(body)].z() = -room;
    }
    return shifts_;
  }

 private:
  // m that the body can go down, `most` where there is that much room or more.
  double RoomBeneath(int body, double most) const {
    double room = std::clamp(bodies_.Box(body, -1).min().z(), 0.0, most);
    for (int other = 0; other < bodies_.size(); ++other) {
      if (other == body || !IsUnder(other, -1, body, -1, room)) continue;
      for (int p = 0; p < bodies_.Parts(other); ++p) {
        if (!IsUnder(other, p, body, -1, room)) continue;
        for (int q = 0; q < bodies_.Parts(body); ++q) {
          if (IsUnder(other, p, body, q, room)) room = WayToMeet(other, p, body, q, room);
        }
      }
    }
    return room;
  }

  // Whether the box of a part of `body`, swept down by `room`, meets that of a part of `other`.
  bool IsUnder(int other, int other_part, int body, int part, double room) const {
    AlignedBox3d swept = bodies_.Box(body, part);
    swept.min().z() -= room;
    AlignedBox3d under = bodies_.Box(other, other_part);
    under.translate(shifts_[static_cast<size_t>(other)]);
    return swept.intersects(under);
  }

  // m down to where two parts meet, no more than `room`.
  double WayToMeet(int other, int other_part, int body, int part, double room) const {
    double way = 0.0;
    for (int i = 0; i < kMostTangents && way < room; ++i) {
      const Vector3d apart = -way * Vector3d::UnitZ() - shifts_[static_cast<size_t>(other)];
      const NearParts near = bodies_.Distance(other, other_part, body, part, apart);
      if (near.normal.z() < kHolds) return room;
      if (near.distance <= kMeets) return way;
      way += near.distance / near.normal.z();
    }
    return std::min(way, room);
  }

  ConvexBodies bodies_;
  std::vector<Vector3d> shifts_;
};

}  // namespace

std::vector<Vector3d> LowerOntoSupports(const std::vector<ProjectedBody>& bodies, double most) {
  if (!(most >= 0.0)) throw core::Error("things are lowered by 0 m or more");
  return Lowering(bodies).Run(most);
}

}  // namespace simwright::scene
