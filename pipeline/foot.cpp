#include "pipeline/foot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "geometry/convex_hull.h"
#include "geometry/stable_poses.h"
#include "geometry/surface_distance.h"

namespace simwright::pipeline {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNearDown = 25.0 * kDegree;
constexpr double kFirm = 3.0 * kDegree;

// Of `points` the farthest in each of `count` directions across `down`.
std::vector<Eigen::Vector3d> Extremes(const std::vector<Eigen::Vector3d>& points,
                                      const Eigen::Vector3d& down, int count) {
  const Eigen::Vector3d u = down.unitOrthogonal(), v = down.cross(u);
  std::set<size_t> chosen;
  for (int i = 0; i < count && points.size() >= 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector3d direction = std::cos(angle) * u + std::sin(angle) * v;
    const auto best = std::max_element(
        points.begin(), points.end(),
        [&](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); });
    chosen.insert(static_cast<size_t>(best - points.begin()));
  }
  std::vector<Eigen::Vector3d> corners;
  for (const size_t c : chosen) corners.push_back(points[c]);
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
  foot.corners = Extremes(low, foot.down, count);
  return foot;
}

void KeepFoot(const Foot& foot, std::vector<core::TriangleMesh>* parts) {
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
  for (size_t i = 0; i < parts->size(); ++i) {
    std::vector<Eigen::Vector3d> points = (*parts)[i].vertices;
    bool below = false;
    for (Eigen::Vector3d& p : points) {
      const double out = p.dot(foot.down) - foot.reach;
      if (out <= 0.0) continue;
      p -= out * foot.down;
      below = true;
    }
    if (added[i].empty() && !below) continue;
    points.insert(points.end(), added[i].begin(), added[i].end());
    const double thinnest = 1e-3 * core::Bounds((*parts)[i]).diagonal().norm();
    (*parts)[i] = geometry::ThickenedConvexHull(points, thinnest);
  }
}

}  // namespace simwright::pipeline
