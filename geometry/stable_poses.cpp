#include "geometry/stable_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSameAngle = 0.5 * std::numbers::pi / 180.0;
constexpr double kSameRestPlane = 1e-4;  // of the diagonal
constexpr double kInside = 1e-6;         // of the diagonal
constexpr double kBarrier = 0.0525;      // of the height; 1 / cos(18 degrees) - 1 plus rounding
constexpr double kRolled = 75.0 * std::numbers::pi / 180.0;

struct Edge {
  Vector3d from, to;
  int across = -1;  // facet
};

// A facet: coplanar triangles of the hull.
struct Facet {
  Vector3d normal = Vector3d::Zero();
  std::vector<Edge> edges;
  double solid_angle = 0.0;  // sr, seen from the centre of mass
  double height = 0.0;       // m, of the centre of mass above it
  double margin = 0.0;       // m, inside the nearest edge; negative outside
  int nearest_edge = -1;
};

double SegmentDistance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double t = std::clamp(ab.dot(p - a) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

// Returns the solid angle of triangle abc seen from the origin, positive if it faces away (Van
// Oosterom and Strackee, "The solid angle of a plane triangle", 1983).
double SolidAngle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

std::map<std::pair<int, int>, int> TriangleOfEdge(const core::TriangleMesh& hull) {
  std::map<std::pair<int, int>, int> triangle_of_edge;
  for (int t = 0; t < static_cast<int>(hull.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      triangle_of_edge[{hull.triangles[t][k], hull.triangles[t][(k + 1) % 3]}] = t;
    }
  }
  return triangle_of_edge;
}

// Assigns each triangle to a facet, grown from the largest triangle on.
std::vector<int> FacetOfTriangle(const core::TriangleMesh& hull, double diagonal,
                                 const std::map<std::pair<int, int>, int>& triangle_of_edge,
                                 int* count) {
  const int n = static_cast<int>(hull.triangles.size());
  std::vector<Vector3d> areas(n);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (int t = 0; t < n; ++t) areas[t] = core::TriangleAreaVector(hull, t);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return areas[a].squaredNorm() > areas[b].squaredNorm(); });
  std::vector<int> facet(n, -1);
  *count = 0;
  for (const int seed : order) {
    if (facet[seed] >= 0) continue;
    const Vector3d normal = areas[seed].normalized();
    const double offset = normal.dot(hull.vertices[hull.triangles[seed][0]]);
    std::vector<int> stack{seed};
    facet[seed] = *count;
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto twin =
            triangle_of_edge.find({hull.triangles[t][(k + 1) % 3], hull.triangles[t][k]});
        if (twin == triangle_of_edge.end() || facet[twin->second] >= 0) continue;
        const int other = twin->second;
        bool same = areas[other].normalized().dot(normal) > std::cos(kSameAngle);
        for (int j = 0; j < 3 && same; ++j) {
          const double off = normal.dot(hull.vertices[hull.triangles[other][j]]) - offset;
          same = std::abs(off) <= kSameRestPlane * diagonal;
        }
        if (!same) continue;
        facet[other] = *count;
        stack.push_back(other);
      }
    }
    ++*count;
  }
  return facet;
}

std::vector<Facet> Facets(const core::TriangleMesh& hull, const Vector3d& center, double diagonal) {
  const auto triangle_of_edge = TriangleOfEdge(hull);
  int count = 0;
  const std::vector<int> facet_of = FacetOfTriangle(hull, diagonal, triangle_of_edge, &count);
  std::vector<Facet> facets(count);
  for (int t = 0; t < static_cast<int>(hull.triangles.size()); ++t) {
    Facet& facet = facets[facet_of[t]];
    const auto& triangle = hull.triangles[t];
    facet.normal += core::TriangleAreaVector(hull, t);
    facet.solid_angle +=
        SolidAngle(hull.vertices[triangle[0]] - center, hull.vertices[triangle[1]] - center,
                   hull.vertices[triangle[2]] - center);
    for (int k = 0; k < 3; ++k) {
      const int from = triangle[k], to = triangle[(k + 1) % 3];
      const int other = facet_of[triangle_of_edge.at({to, from})];
      if (other != facet_of[t]) {
        facet.edges.push_back({hull.vertices[from], hull.vertices[to], other});
      }
    }
  }
  for (Facet& facet : facets) {
    facet.normal.normalize();
    double height = -std::numeric_limits<double>::infinity();
    for (const Edge& edge : facet.edges) {
      height = std::max(height, facet.normal.dot(edge.from - center));
    }
    facet.height = height;
    const Vector3d projection = center + height * facet.normal;
    double inner = std::numeric_limits<double>::infinity();
    double outer = std::numeric_limits<double>::infinity();
    for (int e = 0; e < static_cast<int>(facet.edges.size()); ++e) {
      const Edge& edge = facet.edges[e];
      const Vector3d inward = facet.normal.cross(edge.to - edge.from).normalized();
      const double inside = inward.dot(projection - edge.from);
      inner = std::min(inner, inside);
      const double distance = SegmentDistance(projection, edge.from, edge.to);
      if (inside < kInside * diagonal && distance < outer) {
        outer = distance;
        facet.nearest_edge = e;
      }
    }
    facet.margin = inner;
  }
  return facets;
}

// Returns the corners in order around the facet.
std::vector<Vector3d> FaceCorners(const Facet& facet) {
  Vector3d middle = Vector3d::Zero();
  for (const Edge& edge : facet.edges) middle += edge.from;
  middle /= static_cast<double>(facet.edges.size());
  const Vector3d u = facet.normal.unitOrthogonal();
  const Vector3d v = facet.normal.cross(u);
  std::vector<std::pair<double, Vector3d>> by_angle;
  for (const Edge& edge : facet.edges) {
    by_angle.emplace_back(std::atan2(v.dot(edge.from - middle), u.dot(edge.from - middle)),
                          edge.from);
  }
  std::sort(by_angle.begin(), by_angle.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vector3d> corners;
  for (const auto& [angle, corner] : by_angle) corners.push_back(corner);
  return corners;
}

StablePose PoseOn(const Facet& facet, const Vector3d& center) {
  StablePose pose;
  pose.face_normal = facet.normal;
  pose.margin = facet.margin;
  pose.center_height = facet.height;
  pose.tipping_angle = std::atan2(facet.margin, facet.height);
  pose.support = FaceCorners(facet);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(facet.normal, -Vector3d::UnitZ());
  pose.resting_from_body.linear() = turn.toRotationMatrix();
  pose.resting_from_body.translation() =
      Vector3d(0.0, 0.0, facet.height) - turn.toRotationMatrix() * center;
  return pose;
}

// Returns the facets of the convex hull. Throws core::Error unless the centre of mass is inside.
std::vector<Facet> RequireFacets(const core::TriangleMesh& solid, const Vector3d& center) {
  core::RequireValid(solid, "stable poses");
  if (!center.allFinite()) throw core::Error("the centre of mass is not finite", "stable poses");
  const core::TriangleMesh hull = ConvexHull(solid.vertices);
  std::vector<Facet> facets = Facets(hull, center, core::Bounds(hull).diagonal().norm());
  for (const Facet& facet : facets) {
    if (facet.height <= 0.0) {
      throw core::Error("the centre of mass is not inside the convex hull", "stable poses",
                        "compute it from the closed solid");
    }
  }
  return facets;
}

// Returns the height that the centre of mass must pass when the body rolls over `edge` from one
// facet to another: its height above the edge if it passes over it, else the higher facet's.
double Barrier(const Facet& from, const Facet& to, const Edge& edge, const Vector3d& center) {
  const Vector3d along = (edge.to - edge.from).normalized();
  const Vector3d arm = edge.from - center;
  const Vector3d across = arm - along.dot(arm) * along;  // from the centre to the edge's line
  const bool between = from.normal.cross(across).dot(across.cross(to.normal)) > 0.0;
  return between ? across.norm() : std::max(from.height, to.height);
}

}  // namespace

bool Rolls(const core::TriangleMesh& solid, const Vector3d& center, const Vector3d& down) {
  const std::vector<Facet> facets = RequireFacets(solid, center);
  const auto start = std::max_element(
      facets.begin(), facets.end(),
      [&](const auto& a, const auto& b) { return a.normal.dot(down) < b.normal.dot(down); });
  const double highest = start->height * (1.0 + kBarrier);
  const double lowest = start->height * (1.0 - kBarrier);
  std::vector<bool> reached(facets.size(), false);
  std::vector<size_t> stack{static_cast<size_t>(start - facets.begin())};
  reached[stack[0]] = true;
  while (!stack.empty()) {
    const Facet& facet = facets[stack.back()];
    stack.pop_back();
    if (facet.normal.dot(start->normal) < std::cos(kRolled)) return true;
    for (const Edge& edge : facet.edges) {
      const auto next = static_cast<size_t>(edge.across);
      if (reached[next] || facets[next].height < lowest ||
          Barrier(facet, facets[next], edge, center) > highest) {
        continue;
      }
      reached[next] = true;
      stack.push_back(next);
    }
  }
  return false;
}

std::vector<StablePose> StablePoses(const core::TriangleMesh& solid, const Vector3d& center) {
  const std::vector<Facet> facets = RequireFacets(solid, center);
  const double diagonal = core::Bounds(solid).diagonal().norm();
  const int count = static_cast<int>(facets.size());
  const auto stable = [&](int f) { return facets[f].margin > kInside * diagonal; };
  std::vector<double> share(count, 0.0);
  for (int f = 0; f < count; ++f) {
    int at = f;
    // Each roll lowers the centre of mass, so the sequence is no longer than the number of facets.
    for (int step = 0; step < count && !stable(at); ++step) {
      if (facets[at].nearest_edge < 0) break;
      at = facets[at].edges[facets[at].nearest_edge].across;
    }
    if (stable(at)) share[at] += facets[f].solid_angle;
  }
  const double total = std::accumulate(share.begin(), share.end(), 0.0);
  std::vector<StablePose> poses;
  for (int f = 0; f < count; ++f) {
    if (!stable(f)) continue;
    poses.push_back(PoseOn(facets[f], center));
    poses.back().probability = share[f] / total;
  }
  std::stable_sort(poses.begin(), poses.end(), [](const StablePose& a, const StablePose& b) {
    return a.probability > b.probability;
  });
  return poses;
}

double TippingAngle(const core::TriangleMesh& solid, const Vector3d& center, const Vector3d& down,
                    double slack) {
  core::RequireValid(solid, "tipping angle");
  if (solid.vertices.empty() || !center.allFinite() || !down.allFinite() || down.norm() == 0.0 ||
      !(slack >= 0.0)) {
    throw core::Error("the mesh is empty or an argument is not finite", "tipping angle");
  }
  const Vector3d n = down.normalized();
  const Vector3d u = n.unitOrthogonal();
  const Vector3d v = n.cross(u);
  double lowest = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : solid.vertices) lowest = std::max(lowest, n.dot(p - center));
  std::vector<Vector2d> support;  // relative to the centre of mass
  for (const Vector3d& p : solid.vertices) {
    if (n.dot(p - center) >= lowest - slack)
      support.emplace_back(u.dot(p - center), v.dot(p - center));
  }
  support = ConvexHull2d(std::move(support));
  const std::size_t count = support.size();
  double inside = std::numeric_limits<double>::infinity();
  double outside = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d a = support[i], b = support[(i + 1) % count];
    outside = std::min(outside,
                       SegmentDistance(Vector3d::Zero(), {a.x(), a.y(), 0.0}, {b.x(), b.y(), 0.0}));
    const double length = (b - a).norm();
    if (length > 0.0) inside = std::min(inside, (a.x() * b.y() - a.y() * b.x()) / length);
  }
  const bool is_supported = count >= 3 && inside > 0.0;
  return std::atan2(is_supported ? inside : -outside, std::max(lowest, 0.0));
}

}  // namespace simwright::geometry
