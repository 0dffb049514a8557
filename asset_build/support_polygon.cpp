#include "asset_build/support_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/stable_poses.h"
#include "geometry/surface_distance.h"

namespace simwright::asset_build {
namespace {

constexpr double kSupportPolygonDegree = std::numbers::pi / 180.0;
constexpr double kNearDown = 25.0 * kSupportPolygonDegree;
constexpr double kSupportPolygonFirm = 3.0 * kSupportPolygonDegree;
constexpr double kLevel = 3e-3;   // of the diagonal: vertices this close belong to the face
constexpr double kSpared = 1e-4;  // of the face's area: collinear corners
// The corners of a part on the support face. MuJoCo makes contacts at the lowest corner and at
// those neighbours that are far enough from it: for a round face of 8 corners, three on one side,
// so that a disc sinks by 2 mm; for 16 or more, also the opposite one.
constexpr int kPartCorners = 32;
constexpr int kFewCorners = 7, kEnoughCorners = 16;  // a face in between gets more corners
constexpr double kBulge = 1e-3;                      // of the face's width
constexpr double kThinLevel = 0.25;                  // of the part's height, if that is less
constexpr double kOutside = 0.01;  // of the face's width: a corner the part has lost

using Polygon = std::vector<Eigen::Vector2d>;

// Converts between 3D points and the 2D coordinates of a support plane.
struct SupportPlane {
  explicit SupportPlane(const Eigen::Vector3d& normal)
      : down(normal), u(normal.unitOrthogonal()), v(normal.cross(u)) {}
  Eigen::Vector2d Project(const Eigen::Vector3d& p) const { return {u.dot(p), v.dot(p)}; }
  Eigen::Vector3d Unproject(const Eigen::Vector2d& p, double reach) const {
    return p.x() * u + p.y() * v + reach * down;
  }
  Eigen::Vector3d down, u, v;
};

double AreaOf(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

// Returns the extreme corners in `count` evenly spread directions, the first of which points to the
// corner farthest from the centre.
Polygon EvenCorners(const Polygon& polygon, int count) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : polygon) middle += p / static_cast<double>(polygon.size());
  const Eigen::Vector2d first =
      *std::max_element(polygon.begin(), polygon.end(),
                        [&](const auto& a, const auto& b) {
                          return (a - middle).squaredNorm() <
                                 (b - middle).squaredNorm() * (1.0 - 1e-9);
                        }) -
      middle;
  Polygon even;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2d direction =
        Eigen::Rotation2Dd(2.0 * std::numbers::pi * k / count) * first;
    even.push_back(*std::max_element(
        polygon.begin(), polygon.end(),
        [&](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); }));
  }
  return geometry::ConvexHull2d(std::move(even));
}

// Returns at most `count` corners of a convex polygon: those whose removal costs the least area, or
// evenly spread ones.
Polygon ReducedCorners(const Polygon& polygon, int count) {
  const Polygon fewer = geometry::SimplifyConvexPolygon(polygon, count, kSpared);
  if (static_cast<int>(polygon.size()) <= count) return fewer;
  const Polygon even = EvenCorners(polygon, count);
  return AreaOf(even) >= (1.0 - 1e-6) * AreaOf(fewer) ? even : fewer;
}

// Returns at most `count` corners of the hull of `points` projected along `down`, all at height
// `reach` along it.
std::vector<Eigen::Vector3d> Outline(const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Vector3d& down, double reach, int count) {
  const SupportPlane plane(down);
  Polygon spread;
  for (const Eigen::Vector3d& p : points) spread.push_back(plane.Project(p));
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& p :
       ReducedCorners(geometry::ConvexHull2d(std::move(spread)), count)) {
    corners.push_back(plane.Unproject(p, reach));
  }
  return corners;
}

// Adds corners to the sides of a polygon of 7 to 15 corners; the sides bulge by a thousandth of its
// width.
Polygon WithMoreCorners(const Polygon& polygon) {
  const int corners = static_cast<int>(polygon.size());
  if (corners < kFewCorners || corners >= kEnoughCorners) return polygon;
  Eigen::AlignedBox2d width;
  for (const Eigen::Vector2d& p : polygon) width.extend(p);
  const double bulge = kBulge * width.sizes().maxCoeff();
  const int pieces = (kEnoughCorners + corners - 1) / corners;
  Polygon more;
  for (int i = 0; i < corners; ++i) {
    const Eigen::Vector2d& a = polygon[static_cast<size_t>(i)];
    const Eigen::Vector2d along = polygon[static_cast<size_t>((i + 1) % corners)] - a;
    const Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()).normalized();
    for (int k = 0; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      more.push_back(a + t * along + 4.0 * t * (1.0 - t) * bulge * outward);
    }
  }
  return geometry::ConvexHull2d(std::move(more));
}

bool IsOutside(const Polygon& polygon, const Eigen::Vector2d& p, double slack) {
  if (polygon.size() < 3) return true;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    const Eigen::Vector2d to = p - polygon[i];
    if (along.x() * to.y() - along.y() * to.x() < -slack) return true;
  }
  return false;
}

// Returns the part with its portion of the support face and the `added` corners (see
// PreserveSupportFace).
core::TriangleMesh WithSupportFace(const core::TriangleMesh& part, const SupportPolygon& support,
                                   double diagonal, const std::vector<Eigen::Vector3d>& added,
                                   bool alone, int max_vertices) {
  const SupportPlane plane(support.down);
  double height = 0.0;
  for (const Eigen::Vector3d& p : part.vertices) {
    height = std::max(height, support.reach - p.dot(support.down));
  }
  // If the support is a point, only vertices beyond it are moved.
  const double level =
      support.corners.size() < 3 ? 0.0 : std::min(kLevel * diagonal, kThinLevel * height);
  std::vector<Eigen::Vector3d> points;
  Polygon spread;
  for (const Eigen::Vector3d& p : part.vertices) {
    if (p.dot(support.down) - support.reach < -level) {
      points.push_back(p);
    } else {
      spread.push_back(plane.Project(p));
    }
  }
  const Polygon own = geometry::ConvexHull2d(spread);
  Eigen::AlignedBox2d width;
  for (const Eigen::Vector2d& p : own) width.extend(p);
  for (const Eigen::Vector3d& corner : added) {
    const double slack = own.empty() ? 0.0 : kOutside * width.sizes().maxCoeff();
    if (IsOutside(own, plane.Project(corner), slack)) spread.push_back(plane.Project(corner));
  }
  if (spread.empty()) return part;
  const Polygon corners = geometry::ConvexHull2d(std::move(spread));
  const int room = std::max(3, max_vertices - static_cast<int>(points.size()));
  Polygon chosen = ReducedCorners(corners, std::min(kPartCorners, room));
  if (alone && room >= 2 * kEnoughCorners) chosen = WithMoreCorners(chosen);
  for (const Eigen::Vector2d& p : chosen) points.push_back(plane.Unproject(p, support.reach));
  const double thinnest = 1e-3 * core::Bounds(part).diagonal().norm();
  return geometry::ThickenedConvexHull(points, thinnest, max_vertices);
}

}  // namespace

SupportPolygon FindSupportPolygon(const core::TriangleMesh& solid,
                                  const Eigen::Vector3d& center_of_mass, int count) {
  SupportPolygon support;
  double least = kNearDown;
  const geometry::StablePose* nearest = nullptr;
  const auto poses = geometry::StablePoses(geometry::ConvexHull(solid.vertices), center_of_mass);
  for (const geometry::StablePose& pose : poses) {
    const double tilt = std::acos(std::clamp(-pose.face_normal.z(), -1.0, 1.0));
    if (pose.tipping_angle < kSupportPolygonFirm || tilt >= least) continue;
    least = tilt;
    nearest = &pose;
  }
  std::vector<Eigen::Vector3d> low;
  if (nearest != nullptr) {
    support.down = nearest->face_normal;
    low = nearest->support;
  } else {
    const Eigen::AlignedBox3d box = core::Bounds(solid);
    const double level = box.min().z() + 1e-3 * box.sizes().z();
    for (const Eigen::Vector3d& vertex : solid.vertices) {
      if (vertex.z() <= level) low.push_back(vertex);
    }
  }
  support.reach = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& v : solid.vertices)
    support.reach = std::max(support.reach, v.dot(support.down));
  support.corners = Outline(low, support.down, support.reach, count);
  return support;
}

void PreserveSupportFace(const SupportPolygon& support, int max_vertices,
                         std::vector<core::TriangleMesh>* parts) {
  std::vector<std::vector<Eigen::Vector3d>> added(parts->size());
  for (const Eigen::Vector3d& corner : support.corners) {
    if (support.corners.size() < 3) break;
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
  for (size_t i = 0; i < parts->size(); ++i) {
    (*parts)[i] = WithSupportFace((*parts)[i], support, box.diagonal().norm(), added[i],
                                  parts->size() == 1, max_vertices);
  }
}

}  // namespace simwright::asset_build
