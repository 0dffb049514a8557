#include "geometry/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

// A corner of the Minkowski difference a - b, with the corners that it comes from.
struct Corner {
  Vector3d point = Vector3d::Zero(), on_a = Vector3d::Zero(), on_b = Vector3d::Zero();
};

// The cores of both shapes in the world frame; radii are added at the end.
struct Pair {
  std::vector<Vector3d> a, b;
  double size = 0.0;

  static const Vector3d& Farthest(const std::vector<Vector3d>& points, const Vector3d& direction) {
    std::size_t best = 0;
    double highest = direction.dot(points[0]);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double height = direction.dot(points[i]);
      if (height > highest) {
        highest = height;
        best = i;
      }
    }
    return points[best];
  }

  Corner Support(const Vector3d& direction) const {
    const Vector3d& pa = Farthest(a, direction);
    const Vector3d& pb = Farthest(b, -direction);
    return {pa - pb, pa, pb};
  }
};

// Up to four corners, with the weights of the point of their hull closest to the origin.
struct Simplex {
  std::array<Corner, 4> corner;
  std::array<double, 4> weight;
  int size = 0;

  Vector3d Sum(Vector3d Corner::*field) const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < size; ++i) sum += weight[i] * (corner[i].*field);
    return sum;
  }

  void Keep(std::initializer_list<int> which, std::initializer_list<double> weights) {
    std::array<Corner, 4> kept;
    int n = 0;
    auto w = weights.begin();
    for (const int i : which) {
      kept[n] = corner[i];
      weight[n++] = *w++;
    }
    corner = kept;
    size = n;
  }
};

// The following functions reduce a simplex to the feature closest to the origin by Voronoi regions
// (Ericson, Real-Time Collision Detection, 2005, 5.1 and 9.5).
void ReduceSegment(Simplex* s) {
  const Vector3d ab = s->corner[1].point - s->corner[0].point;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? -s->corner[0].point.dot(ab) / length : 0.0;
  if (t <= 0.0) {
    s->Keep({0}, {1.0});
  } else if (t >= 1.0) {
    s->Keep({1}, {1.0});
  } else {
    s->weight = {1.0 - t, t, 0.0, 0.0};
  }
}

void ReduceTriangle(Simplex* s) {
  const Vector3d a = s->corner[0].point, b = s->corner[1].point, c = s->corner[2].point;
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0.0 && d2 <= 0.0) return s->Keep({0}, {1.0});
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0.0 && d4 <= d3) return s->Keep({1}, {1.0});
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) {
    const double t = d1 / (d1 - d3);
    return s->Keep({0, 1}, {1.0 - t, t});
  }
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0.0 && d5 <= d6) return s->Keep({2}, {1.0});
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) {
    const double t = d2 / (d2 - d6);
    return s->Keep({0, 2}, {1.0 - t, t});
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && (d4 - d3) + (d5 - d6) > 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return s->Keep({1, 2}, {1.0 - t, t});
  }
  const double sum = va + vb + vc;
  s->weight = {va / sum, vb / sum, vc / sum, 0.0};
}

// Returns true if the origin is inside; the simplex is then unchanged.
bool ReduceTetrahedron(Simplex* s) {
  static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
  Simplex best;
  double closest = std::numeric_limits<double>::infinity();
  bool outside = false;
  for (const auto& f : kFaces) {
    const Vector3d& a = s->corner[f[0]].point;
    const Vector3d normal = (s->corner[f[1]].point - a).cross(s->corner[f[2]].point - a);
    const double origin_side = -normal.dot(a);
    const double inner_side = normal.dot(s->corner[f[3]].point - a);
    // A flat tetrahedron has no interior: try each of its faces.
    const double flat = 1e-14 * normal.norm() * (s->corner[f[3]].point - a).norm();
    if (std::abs(inner_side) > flat && origin_side * inner_side >= 0.0) continue;
    outside = true;
    Simplex face = *s;
    face.Keep({f[0], f[1], f[2]}, {1.0, 0.0, 0.0});
    ReduceTriangle(&face);
    const double distance = face.Sum(&Corner::point).squaredNorm();
    if (distance < closest) {
      closest = distance;
      best = face;
    }
  }
  if (outside) *s = best;
  return !outside;
}

// Runs GJK. Returns true if the cores are separated by more than rounding; `simplex` then holds the
// closest feature of the Minkowski difference.
bool CoresSeparated(const Pair& pair, Simplex* simplex) {
  const double touching = 1e-12 * pair.size;
  simplex->size = 1;
  simplex->corner[0] = pair.Support(Vector3d::UnitX());
  simplex->weight[0] = 1.0;
  Vector3d v = simplex->corner[0].point;
  for (int step = 0; step < 200; ++step) {
    const double distance = v.norm();
    if (distance <= touching) return false;
    const Corner w = pair.Support(-v);
    // v| - w.v/|v| bounds the error from above.
    if (distance - w.point.dot(v) / distance <= 1e-13 * pair.size + 1e-12 * distance) return true;
    for (int i = 0; i < simplex->size; ++i) {
      if (w.point == simplex->corner[i].point) return true;
    }
    const Simplex before = *simplex;
    simplex->corner[simplex->size++] = w;
    if (simplex->size == 2) {
      ReduceSegment(simplex);
    } else if (simplex->size == 3) {
      ReduceTriangle(simplex);
    } else if (ReduceTetrahedron(simplex)) {
      return false;
    }
    const Vector3d next = simplex->Sum(&Corner::point);
    if (!(next.squaredNorm() < v.squaredNorm())) {  // no further progress in double precision
      *simplex = before;
      return true;
    }
    v = next;
  }
  return true;
}

// The expanding polytope algorithm around an origin inside the Minkowski difference.
class ExpandingPolytope {
 public:
  explicit ExpandingPolytope(const Pair& pair) : pair_(pair) {}

  // Returns false if the difference is flat; then `normal` is perpendicular to it.
  bool Start(Vector3d* normal) {
    const double flat = 1e-10 * pair_.size;
    corners_.push_back(pair_.Support(Vector3d::UnitX()));
    if (!Extend({Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}, flat,
                [&](const auto& p) { return (p - corners_[0].point).norm(); })) {
      *normal = Vector3d::UnitZ();
      return false;
    }
    const Vector3d along = (corners_[1].point - corners_[0].point).normalized();
    const Vector3d side = along.unitOrthogonal();
    const Vector3d third = along.cross(side);
    if (!Extend({side, third}, flat,
                [&](const auto& p) { return along.cross(p - corners_[0].point).norm(); })) {
      *normal = side;
      return false;
    }
    const Vector3d across = along.cross(corners_[2].point - corners_[0].point).normalized();
    if (!Extend({across}, flat,
                [&](const auto& p) { return std::abs(across.dot(p - corners_[0].point)); })) {
      *normal = across;
      return false;
    }
    for (int i = 0; i < 4; ++i) inside_ += 0.25 * corners_[i].point;
    for (const auto& f : {std::array{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}) AddFace(f);
    return true;
  }

  // Returns the face closest to the origin once no face can be expanded further.
  ConvexDistance Depth() {
    const double tolerance = 1e-11 * pair_.size;
    std::size_t nearest = 0;
    for (int step = 0; step < 1000; ++step) {
      nearest = Nearest();
      const Corner w = pair_.Support(faces_[nearest].normal);
      if (faces_[nearest].normal.dot(w.point) - faces_[nearest].offset <= tolerance) break;
      if (!Push(w, tolerance)) break;
    }
    return Result(faces_[nearest]);
  }

 private:
  struct Face {
    std::array<int, 3> corner;
    Vector3d normal;
    double offset;
  };

  template <typename Measure>
  bool Extend(std::initializer_list<Vector3d> directions, double flat, Measure measure) {
    Corner best;
    double farthest = flat;
    bool found = false;
    for (const Vector3d& direction : directions) {
      for (const double sign : {1.0, -1.0}) {
        const Corner c = pair_.Support(sign * direction);
        const double m = measure(c.point);
        if (m <= farthest) continue;
        farthest = m;
        best = c;
        found = true;
      }
    }
    if (found) corners_.push_back(best);
    return found;
  }

  void AddFace(std::array<int, 3> f) {
    const Vector3d& a = corners_[f[0]].point;
    Vector3d normal = (corners_[f[1]].point - a).cross(corners_[f[2]].point - a);
    const double norm = normal.norm();
    // A needle has no reliable normal; exclude it from the nearest-face search.
    if (!(norm > 1e-20 * pair_.size * pair_.size)) {
      faces_.push_back({f, Vector3d::Zero(), std::numeric_limits<double>::infinity()});
      return;
    }
    normal /= norm;
    if (normal.dot(inside_ - a) > 0.0) {
      normal = -normal;
      std::swap(f[1], f[2]);
    }
    faces_.push_back({f, normal, normal.dot(a)});
  }

  std::size_t Nearest() const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < faces_.size(); ++i) {
      if (faces_[i].offset < faces_[nearest].offset) nearest = i;
    }
    return nearest;
  }

  bool Push(const Corner& w, double tolerance) {
    std::vector<std::array<int, 2>> rim;
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      if (!(face.normal.dot(w.point) - face.offset > 0.1 * tolerance)) {
        kept.push_back(face);
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const std::array<int, 2> edge{face.corner[k], face.corner[(k + 1) % 3]};
        const auto twin = std::find(rim.begin(), rim.end(), std::array<int, 2>{edge[1], edge[0]});
        if (twin != rim.end()) {
          rim.erase(twin);
        } else {
          rim.push_back(edge);
        }
      }
    }
    if (kept.size() == faces_.size() || rim.empty()) return false;
    faces_ = std::move(kept);
    corners_.push_back(w);
    for (const auto& edge : rim) {
      AddFace({edge[0], edge[1], static_cast<int>(corners_.size()) - 1});
    }
    return true;
  }

  ConvexDistance Result(const Face& face) const {
    Simplex s;
    s.size = 3;
    const Vector3d projection = face.normal * face.offset;
    for (int k = 0; k < 3; ++k) {
      s.corner[k] = corners_[face.corner[k]];
      s.corner[k].point -= projection;
    }
    ReduceTriangle(&s);
    ConvexDistance result;
    // The nearest point n d of a - b means: b must move by n d to separate from a.
    result.distance = -std::max(0.0, face.offset);
    result.normal = face.normal;
    result.point_a = s.Sum(&Corner::on_a);
    result.point_b = s.Sum(&Corner::on_b);
    return result;
  }

  const Pair& pair_;
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
  Vector3d inside_ = Vector3d::Zero();
};

void AddPlaced(const ConvexShape& shape, const Eigen::Isometry3d& pose,
               std::vector<Vector3d>* placed, Eigen::AlignedBox3d* bounds) {
  if (shape.vertices.empty()) throw core::Error("a convex shape has no vertices", "distance");
  if (!(shape.radius >= 0.0) || !std::isfinite(shape.radius) || !pose.matrix().allFinite()) {
    throw core::Error("a radius or pose is not finite or negative", "distance");
  }
  placed->reserve(shape.vertices.size());
  for (const Vector3d& v : shape.vertices) {
    if (!v.allFinite()) throw core::Error("a vertex is not finite", "distance");
    placed->push_back(pose * v);
    bounds->extend(placed->back());
  }
}

}  // namespace

ConvexDistance SignedDistance(const ConvexShape& a, const Eigen::Isometry3d& world_from_a,
                              const ConvexShape& b, const Eigen::Isometry3d& world_from_b) {
  Pair pair;
  Eigen::AlignedBox3d bounds_a, bounds_b;
  AddPlaced(a, world_from_a, &pair.a, &bounds_a);
  AddPlaced(b, world_from_b, &pair.b, &bounds_b);
  // Centre the bodies: precision then depends on their size, not on their distance from the origin.
  const Vector3d middle = bounds_a.center();
  for (Vector3d& v : pair.a) v -= middle;
  for (Vector3d& v : pair.b) v -= middle;
  pair.size = std::max(bounds_a.diagonal().norm() + bounds_b.diagonal().norm(), 1e-300);
  ConvexDistance result;
  Simplex simplex;
  if (CoresSeparated(pair, &simplex)) {
    const Vector3d v = simplex.Sum(&Corner::point);
    result.distance = v.norm();
    result.normal = -v / result.distance;
    result.point_a = simplex.Sum(&Corner::on_a);
  } else {
    ExpandingPolytope polytope(pair);
    Vector3d across;
    if (polytope.Start(&across)) {
      result = polytope.Depth();
    } else {
      result.normal = across;
      result.point_a = simplex.size == 4 ? simplex.corner[0].on_a : simplex.Sum(&Corner::on_a);
    }
  }
  result.distance -= a.radius + b.radius;
  result.point_a += middle + a.radius * result.normal;
  result.point_b = result.point_a + result.distance * result.normal;
  return result;
}

ConvexDistance SignedDistance(const ConvexShape& a, const ConvexShape& b) {
  return SignedDistance(a, Eigen::Isometry3d::Identity(), b, Eigen::Isometry3d::Identity());
}

bool AreApart(const ConvexShape& a, const ConvexShape& b, double margin) {
  const double apart = margin + a.radius + b.radius;
  Simplex simplex;
  simplex.size = 1;
  simplex.weight = {1.0, 0.0, 0.0, 0.0};
  simplex.corner[0].point = a.vertices.front() - b.vertices.front();
  Vector3d v = simplex.corner[0].point;
  for (int step = 0; step < 100; ++step) {
    const double distance = v.norm();  // an upper bound: v is a point of the difference
    if (distance <= apart) return false;
    Corner w;
    w.point = Pair::Farthest(a.vertices, -v) - Pair::Farthest(b.vertices, v);
    const double lower_bound = w.point.dot(v) / distance;
    if (lower_bound > apart) return true;
    if (distance - lower_bound <= 1e-9 * distance) return true;
    for (int i = 0; i < simplex.size; ++i) {
      if (w.point == simplex.corner[i].point) return true;
    }
    simplex.corner[simplex.size++] = w;
    if (simplex.size == 2) {
      ReduceSegment(&simplex);
    } else if (simplex.size == 3) {
      ReduceTriangle(&simplex);
    } else if (ReduceTetrahedron(&simplex)) {
      return false;
    }
    const Vector3d next = simplex.Sum(&Corner::point);
    if (!(next.squaredNorm() < v.squaredNorm())) return true;
    v = next;
  }
  return true;
}

ConvexDistance SignedDistanceToParts(const std::vector<core::TriangleMesh>& parts,
                                     const ConvexShape& body, int* part) {
  if (parts.empty()) throw core::Error("there are no parts", "distance");
  Eigen::AlignedBox3d reach;
  for (const Vector3d& v : body.vertices) reach.extend(v);
  ConvexDistance best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double apart = std::sqrt(core::Bounds(parts[i]).squaredExteriorDistance(reach));
    if (apart - body.radius > std::max(0.0, best.distance) && i > 0) continue;
    const ConvexDistance d = SignedDistance({parts[i].vertices, 0.0}, body);
    if (d.distance < best.distance) {
      best = d;
      if (part != nullptr) *part = static_cast<int>(i);
    }
  }
  return best;
}

}  // namespace simwright::geometry
