#include "geometry/round_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/mass_properties.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBallTolerance = 0.02;     // of its radius: largest deviation of an ellipsoid's
                                            // vertex
constexpr double kProfileTolerance = 0.02;  // of the largest radius: largest deviation of a solid
                                            // of revolution's vertex
constexpr double kSweptShare = 0.96;        // of the swept profile's volume: a prism of 13 corners
constexpr double kNearAxis = 1e-3;          // of the largest radius: a vertex on the axis
constexpr double kSameRing = 1e-5;          // of the largest radius: rounding within a ring
constexpr int kVolumeSteps = 30;            // bisection steps
constexpr std::array<int, 7> kCorners{32, 24, 16, 12, 10, 8, 6};  // corners per ring

// The hull's centre and principal axes (columns, right-handed), and the spread along each.
struct Frame {
  Vector3d center = Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector3d spread = Vector3d::Ones();  // m, standard deviation of the volume

  Vector3d ToFrame(const Vector3d& p) const { return axes.transpose() * (p - center); }
  Vector3d FromFrame(const Vector3d& p) const { return axes * p + center; }
};

Frame FrameOf(const core::TriangleMesh& hull) {
  const MassProperties mass = SolidMassProperties(hull, 1.0);
  const Eigen::Matrix3d covariance =
      0.5 * mass.inertia.trace() * Eigen::Matrix3d::Identity() - mass.inertia;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance / mass.mass);
  Frame frame;
  frame.center = mass.center_of_mass;
  frame.axes = solver.eigenvectors();
  if (frame.axes.determinant() < 0.0) frame.axes.col(0) *= -1.0;
  frame.spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return frame;
}

// Returns the directions of the icosahedron's corners, faces and edges, as many of these sets as
// fit: 62, 42 or 32 evenly distributed directions with 120 symmetries.
std::vector<Vector3d> IcosahedralDirections(int max_vertices) {
  const double g = std::numbers::phi;
  std::vector<Vector3d> corners, faces, edges;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      for (int k = 0; k < 3; ++k) {
        Vector3d p = Vector3d::Zero();
        p[k] = s;
        p[(k + 1) % 3] = t;
        corners.push_back(p.normalized());
      }
    }
  }
  const double edge = 2.0 / std::sqrt(1.0 + g * g) * 1.01;
  for (size_t a = 0; a < corners.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      if ((corners[a] - corners[b]).norm() > edge) continue;
      edges.push_back((corners[a] + corners[b]).normalized());
      for (size_t c = 0; c < b; ++c) {
        if ((corners[a] - corners[c]).norm() > edge || (corners[b] - corners[c]).norm() > edge) {
          continue;
        }
        faces.push_back((corners[a] + corners[b] + corners[c]).normalized());
      }
    }
  }
  std::vector<Vector3d> directions = corners;
  if (max_vertices >= 62) {
    directions.insert(directions.end(), faces.begin(), faces.end());
    directions.insert(directions.end(), edges.begin(), edges.end());
  } else if (max_vertices >= 42) {
    directions.insert(directions.end(), edges.begin(), edges.end());
  } else if (max_vertices >= 32) {
    directions.insert(directions.end(), faces.begin(), faces.end());
  }
  return directions;
}

// Scales the mesh about `center` to the given volume.
void ScaleToVolume(double volume, const Vector3d& center, core::TriangleMesh* mesh) {
  const double factor = std::cbrt(volume / SignedVolume(*mesh));
  for (Vector3d& v : mesh->vertices) v = center + factor * (v - center);
}

std::optional<core::TriangleMesh> AsEllipsoid(const core::TriangleMesh& hull, const Frame& frame,
                                              int max_vertices) {
  const Vector3d radii = std::sqrt(5.0) * frame.spread;  // a ball's radius is sqrt(5) times its
                                                         // spread
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
  for (const Vector3d& v : hull.vertices) {
    const double r = frame.ToFrame(v).cwiseQuotient(radii).norm();
    nearest = std::min(nearest, r);
    farthest = std::max(farthest, r);
  }
  if (farthest - nearest > kBallTolerance * farthest) return std::nullopt;
  // A few vertices may lie on a ball and yet bound half of one, or a cuboid.
  const double ball = 4.0 / 3.0 * std::numbers::pi * radii.prod() * std::pow(farthest, 3);
  if (SignedVolume(hull) < 0.9 * ball) return std::nullopt;
  std::vector<Vector3d> points;
  for (const Vector3d& d : IcosahedralDirections(max_vertices)) {
    points.push_back(frame.FromFrame(d.cwiseProduct(radii)));
  }
  core::TriangleMesh round = ConvexHull(points);
  ScaleToVolume(SignedVolume(hull), frame.center, &round);
  return round;
}

// A hull viewed along one of its principal axes, scaled so that its cross-section is round.
struct Revolution {
  Frame frame;
  int axis = 2;  // column of frame.axes
  double stretch_u = 1.0, stretch_v = 1.0;
  std::vector<Vector2d> profile;  // (radius, height), ascending height, radius 0 at closed ends
  double radius = 0.0;            // m, the largest
  double phase = 0.0;             // rad, of the outermost corner

  Vector3d ToRound(const Vector3d& p) const {
    const Vector3d q = frame.ToFrame(p);
    return {q[(axis + 1) % 3] * stretch_u, q[(axis + 2) % 3] * stretch_v, q[axis]};
  }
  Vector3d FromRound(const Vector3d& p) const {
    Vector3d q;
    q[(axis + 1) % 3] = p.x() / stretch_u;
    q[(axis + 2) % 3] = p.y() / stretch_v;
    q[axis] = p.z();
    return frame.FromFrame(q);
  }
};

// Returns the volume of the profile's solid of revolution, summed over frustums.
double SweptVolume(const std::vector<Vector2d>& profile) {
  double volume = 0.0;
  for (size_t i = 1; i < profile.size(); ++i) {
    const double a = profile[i - 1].x(), b = profile[i].x();
    volume +=
        std::numbers::pi / 3.0 * (profile[i].y() - profile[i - 1].y()) * (a * a + a * b + b * b);
  }
  return volume;
}

double DistanceToProfile(const std::vector<Vector2d>& profile, const Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 1; i < profile.size(); ++i) {
    const Vector2d along = profile[i] - profile[i - 1];
    const double length = std::max(along.squaredNorm(), 1e-300);
    const double t = std::clamp(along.dot(p - profile[i - 1]) / length, 0.0, 1.0);
    least = std::min(least, (p - profile[i - 1] - t * along).norm());
  }
  return least;
}

// Returns the convex profile of the points (radius, height), mirrored so that the hull closes at
// the axis.
std::vector<Vector2d> ProfileOf(const std::vector<Vector2d>& points, double near_axis) {
  std::vector<Vector2d> both = points;
  for (const Vector2d& p : points) both.emplace_back(-p.x(), p.y());
  std::vector<Vector2d> profile;
  for (const Vector2d& p : ConvexHull2d(std::move(both))) {
    if (p.x() >= -near_axis) profile.emplace_back(p.x() < near_axis ? 0.0 : p.x(), p.y());
  }
  std::sort(profile.begin(), profile.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
  });
  return profile;
}

std::optional<Revolution> AsRevolution(const core::TriangleMesh& hull, const Frame& frame,
                                       int axis) {
  Revolution round;
  round.frame = frame;
  round.axis = axis;
  const double u = frame.spread[(axis + 1) % 3], v = frame.spread[(axis + 2) % 3];
  if (!(u > 0.0) || !(v > 0.0)) return std::nullopt;
  round.stretch_u = std::sqrt(v / u);
  round.stretch_v = std::sqrt(u / v);
  std::vector<Vector2d> points;
  for (const Vector3d& vertex : hull.vertices) {
    const Vector3d p = round.ToRound(vertex);
    const double r = std::hypot(p.x(), p.y());
    points.emplace_back(r, p.z());
    if (r <= round.radius * (1.0 + 1e-9)) continue;
    round.radius = r;
    round.phase = std::atan2(p.y(), p.x());
  }
  const double grain = kSameRing * round.radius;
  std::vector<Vector2d> rings;
  for (const Vector2d& p : points) {
    rings.emplace_back(grain * std::round(p.x() / grain), grain * std::round(p.y() / grain));
  }
  round.profile = ProfileOf(std::move(rings), kNearAxis * round.radius);
  if (round.profile.size() < 2) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  round.profile.front().y() = lowest->y();  // keep the ends exactly in their planes
  round.profile.back().y() = highest->y();
  if (SignedVolume(hull) < kSweptShare * SweptVolume(round.profile)) return std::nullopt;
  for (const Vector2d& p : points) {
    if (DistanceToProfile(round.profile, p) > kProfileTolerance * round.radius) return std::nullopt;
  }
  return round;
}

int CountVertices(const std::vector<Vector2d>& profile, int corners) {
  int count = 0;
  for (const Vector2d& p : profile) count += p.x() > 0.0 ? corners : 1;
  return count;
}

// Returns the volume that the profile loses without its point `i`.
double LossWithout(const std::vector<Vector2d>& profile, size_t i) {
  const std::vector<Vector2d> part{profile[i - 1], profile[i], profile[i + 1]};
  return SweptVolume(part) - SweptVolume({profile[i - 1], profile[i + 1]});
}

// Removes the points that cost the least volume until the profile's rings of `corners` corners fit.
// Keeps the ends. Returns an empty profile if they do not fit.
std::vector<Vector2d> FittingProfile(std::vector<Vector2d> profile, int corners, int max_vertices) {
  while (CountVertices(profile, corners) > max_vertices) {
    size_t least = 0;
    double cost = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i + 1 < profile.size(); ++i) {
      const double loss = LossWithout(profile, i);
      if (loss >= cost) continue;
      cost = loss;
      least = i;
    }
    if (least == 0) return {};
    profile.erase(profile.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return profile;
}

// Builds the polyhedron of a profile. Flat ends are scaled by `end`, rings between them by `inner`.
core::TriangleMesh Swept(const Revolution& round, const std::vector<Vector2d>& profile, int corners,
                         double end, double inner) {
  std::vector<Vector3d> points;
  for (size_t ring = 0; ring < profile.size(); ++ring) {
    const Vector2d& p = profile[ring];
    if (p.x() == 0.0) {
      points.push_back(round.FromRound({0.0, 0.0, p.y()}));
      continue;
    }
    const double radius = p.x() * (ring == 0 || ring + 1 == profile.size() ? end : inner);
    for (int i = 0; i < corners; ++i) {
      const double angle = round.phase + 2.0 * std::numbers::pi * i / corners;
      points.push_back(
          round.FromRound({radius * std::cos(angle), radius * std::sin(angle), p.y()}));
    }
  }
  return ConvexHull(points);
}

// Returns how far the corners of a regular polygon stick out of the circle of the same area.
double CornerExcess(int corners) {
  const double step = 2.0 * std::numbers::pi / corners;
  return std::sqrt(step / std::sin(step)) - 1.0;
}

std::optional<core::TriangleMesh> Simplified(const Revolution& round, double volume,
                                             int max_vertices) {
  std::vector<Vector2d> best;
  int best_corners = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const int corners : kCorners) {
    std::vector<Vector2d> profile = FittingProfile(round.profile, corners, max_vertices);
    if (profile.size() < 2) continue;
    double error = CornerExcess(corners) * round.radius;
    for (const Vector2d& p : round.profile) error = std::max(error, DistanceToProfile(profile, p));
    if (error >= least) continue;
    least = error;
    best = std::move(profile);
    best_corners = corners;
  }
  if (best.empty()) return std::nullopt;
  // Ends keep their area, which is the circle's times the volume share.
  const double share = volume / SweptVolume(round.profile);
  const double end = std::sqrt(share) * (1.0 + CornerExcess(best_corners));
  double low = 0.9 * end, high = 1.5 * end;
  for (int step = 0; step < kVolumeSteps; ++step) {
    const double middle = 0.5 * (low + high);
    (SignedVolume(Swept(round, best, best_corners, end, middle)) < volume ? low : high) = middle;
  }
  return Swept(round, best, best_corners, end, low);
}

}  // namespace

std::optional<core::TriangleMesh> SimplifyRoundHull(const core::TriangleMesh& hull,
                                                    int max_vertices) {
  if (max_vertices < 16) {
    throw core::Error("a round hull needs at least 16 vertices", "convex hull");
  }
  const Frame frame = FrameOf(hull);
  if (auto ball = AsEllipsoid(hull, frame, max_vertices)) return ball;
  const double volume = SignedVolume(hull);
  std::optional<core::TriangleMesh> best;
  double roundest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<Revolution> round = AsRevolution(hull, frame, axis);
    if (!round) continue;
    const double share = volume / SweptVolume(round->profile);
    if (share <= roundest) continue;
    if (auto simplified = Simplified(*round, volume, max_vertices)) {
      roundest = share;
      best = std::move(simplified);
    }
  }
  return best;
}

}  // namespace simwright::geometry
