#include "pipeline/foot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/convex_hull.h"
#include "geometry/plane_hull.h"
#include "geometry/stable_poses.h"
#include "geometry/surface_distance.h"

namespace simwright::pipeline {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNearDown = 25.0 * kDegree;
constexpr double kFirm = 3.0 * kDegree;
constexpr double kLevel = 3e-3;   // of the diagonal: what is that near to the flat is part of it
constexpr double kSpared = 0.05;  // of the flat's area: fewer corners give steadier contacts
constexpr int kPartCorners = 8;   // of a part on the flat; more lie closer than contacts need

// At most `count` corners of what `points` span across `down`, all at height `reach` along it.
std::vector<Eigen::Vector3d> Outline(const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Vector3d& down, double reach, int count) {
  const Eigen::Vector3d u = down.unitOrthogonal(), v = down.cross(u);
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& p : points) flat.emplace_back(u.dot(p), v.dot(p));
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& p :
       geometry::FewerCorners(geometry::PlaneHull(std::move(flat)), count, kSpared)) {
    corners.push_back(p.x() * u + p.y() * v + reach * down);
  }
  return corners;
}

}  // namespace

Foot FindFoot(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass, int count) {
  Foot foot;
  double least = kNearDown;
  const geometry::StablePose* nearest = nullptr;
  const auto poses = geometry::StablePoses(geometry::ConvexHull(solid.vertices), center_of_mass);
  for (const geometry::StablePose& pose : poses) {
    const double tilt = std::acos(std::clamp(-pose.face_normal.z(), -1.0, 1.0));
    if (pose.tipping_angle < kFirm || tilt >= least) continue;
    least = tilt;
    nearest = &pose;
  }
  std::vector<Eigen::Vector3d> low;
  if (nearest != nullptr) {
    foot.down = nearest->face_normal;
    low = nearest->support;
  } else {
    const Eigen::AlignedBox3d box = core::Bounds(solid);
    const double level = box.min().z() + 1e-3 * box.sizes().z();
    for (const Eigen::Vector3d& vertex : solid.vertices) {
      if (vertex.z() <= level) low.push_back(vertex);
    }
  }
  foot.reach = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& v : solid.vertices)
    foot.reach = std::max(foot.reach, v.dot(foot.down));
  foot.corners = Outline(low, foot.down, foot.reach, count);
  return foot;
}

void KeepFoot(const Foot& foot, int max_vertices, std::vector<core::TriangleMesh>* parts) {
  if (foot.corners.size() < 3) return;
  std::vector<std::vector<Eigen::Vector3d>> added(parts->size());
  for (const Eigen::Vector3d& corner : foot.corners) {
    size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < parts->size(); ++i) {
      const double distance = geometry::DistancesToSurface({corner}, (*parts)[i])[0];
      if (distance >= least) continue;
      least = distance;
      nearest = i;
    }
    added[nearest].push_back(corner);
  }
  Eigen::AlignedBox3d box;
  for (const core::TriangleMesh& part : *parts) box.extend(core::Bounds(part));
  const double level = kLevel * box.diagonal().norm();
  for (size_t i = 0; i < parts->size(); ++i) {
    std::vector<Eigen::Vector3d> points, on_foot = added[i];
    for (const Eigen::Vector3d& p : (*parts)[i].vertices) {
      const double out = p.dot(foot.down) - foot.reach;
      if (out < -level) {
        points.push_back(p);
      } else {
        on_foot.push_back(p - out * foot.down);
      }
    }
    if (on_foot.empty()) continue;
    on_foot = Outline(on_foot, foot.down, foot.reach, kPartCorners);
    points.insert(points.end(), on_foot.begin(), on_foot.end());
    const double thinnest = 1e-3 * core::Bounds((*parts)[i]).diagonal().norm();
    (*parts)[i] = geometry::ThickenedConvexHull(points, thinnest, max_vertices);
  }
}

}  // namespace simwright::pipeline
