// Compares this project's signed distance of convex bodies (geometry/distance.h) with FCL, which
// computes it by libccd, on random pairs. The reference is a closed form
// for boxes of one orientation; for other pairs it is the separating axis theorem over all normals
// of faces and products of edges, or, for separate bodies, the nearest pair of features.
//   bench_distance_table [--pairs N]
// Columns: the errors of the distance over the pair's size, the calls that threw or returned no
// finite number or an error above 1 % of the size, and the mean time of a call.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/distance.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/random.h"
#include "geometry/convex_hull.h"
#include "geometry/distance.h"
#include "geometry/surface_distance.h"

namespace simwright::bench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kWrong = 0.01;  // of the size: an error that a simulation would show

// Two bodies in their own frames.
struct BodyPair {
  core::TriangleMesh mesh[2];
  Isometry3d pose[2] = {Isometry3d::Identity(), Isometry3d::Identity()};
  double distance = 0.0;  // the reference, m
  double size = 0.0;      // sum of the diagonals, m
};

core::TriangleMesh BoxMesh(const Vector3d& half) {
  std::vector<Vector3d> corners;
  for (int c = 0; c < 8; ++c) {
    corners.push_back(half.cwiseProduct(Vector3d(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  }
  return geometry::ConvexHull(corners);
}

Isometry3d RandomPose(const Vector3d& position, core::Rng& rng) {
  Isometry3d pose(Eigen::Translation3d{position});
  pose.rotate(Eigen::AngleAxisd(core::Uniform(rng, 0.0, 3.1), core::UniformDirection(rng)));
  return pose;
}

double BoxDistance(const Vector3d& half_a, const Vector3d& half_b, const Vector3d& apart) {
  const Vector3d gap = apart.cwiseAbs() - half_a - half_b;
  return gap.maxCoeff() > 0.0 ? gap.cwiseMax(0.0).norm() : gap.maxCoeff();
}

// Returns two boxes of one orientation; the reference is closed.
BodyPair AlignedBoxes(const Vector3d& half_a, const Vector3d& half_b, const Vector3d& apart,
                      core::Rng& rng) {
  BodyPair pair;
  pair.mesh[0] = BoxMesh(half_a);
  pair.mesh[1] = BoxMesh(half_b);
  pair.pose[0] = RandomPose({1.0, -2.0, 0.5}, rng);
  pair.pose[1] = pair.pose[0] * Eigen::Translation3d(apart);
  pair.distance = BoxDistance(half_a, half_b, apart);
  return pair;
}

Vector3d RandomHalf(core::Rng& rng) {
  return {core::Uniform(rng, .2, 2), core::Uniform(rng, .2, 2), core::Uniform(rng, .2, 2)};
}

BodyPair Boxes(core::Rng& rng) {
  const Vector3d apart = 4.0 * core::Uniform(rng) * core::UniformDirection(rng);
  return AlignedBoxes(RandomHalf(rng), RandomHalf(rng), apart, rng);
}

// Returns a box that stands on another, with a gap or an overlap of at most a micrometre.
BodyPair StackedBoxes(core::Rng& rng) {
  const Vector3d a = 0.1 * RandomHalf(rng), b = 0.1 * RandomHalf(rng);
  const Vector3d apart(0.01 * core::Uniform(rng), 0.01 * core::Uniform(rng),
                       a.z() + b.z() + core::Uniform(rng, -1e-6, 1e-6));
  return AlignedBoxes(a, b, apart, rng);
}

core::TriangleMesh RandomHull(core::Rng& rng) {
  std::vector<Vector3d> points;
  const int count = 20 + static_cast<int>(core::UniformIndex(rng, 20));
  const Vector3d scale = Vector3d::Constant(0.5) + 0.5 * RandomHalf(rng);
  for (int i = 0; i < count; ++i) {
    points.push_back(core::UniformDirection(rng).cwiseProduct(scale));
  }
  return geometry::ConvexHull(points);
}

BodyPair HullsWithin(double reach, core::Rng& rng) {
  BodyPair pair;
  for (int k = 0; k < 2; ++k) {
    pair.mesh[k] = RandomHull(rng);
    const Vector3d at = k * reach * core::Uniform(rng) * core::UniformDirection(rng);
    pair.pose[k] = RandomPose(at, rng);
  }
  return pair;
}

BodyPair Hulls(core::Rng& rng) {
  return HullsWithin(5.0, rng);
}

BodyPair DeepHulls(core::Rng& rng) {
  return HullsWithin(0.1, rng);
}

// Returns two plates 1 m wide and 2 mm thick.
BodyPair Plates(core::Rng& rng) {
  BodyPair pair;
  for (int k = 0; k < 2; ++k) {
    pair.mesh[k] = BoxMesh({0.5, 0.5, 0.001});
    const Vector3d at = k * core::Uniform(rng) * core::UniformDirection(rng);
    pair.pose[k] = RandomPose(at, rng);
  }
  return pair;
}

std::vector<std::array<Vector3d, 2>> Edges(const core::TriangleMesh& mesh) {
  std::vector<std::array<Vector3d, 2>> edges;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (a < b) edges.push_back({mesh.vertices[a], mesh.vertices[b]});
    }
  }
  return edges;
}

// Returns the distance from a to b along the unit vector `n`: negative where they overlap.
double Separation(const core::TriangleMesh& a, const core::TriangleMesh& b, const Vector3d& n) {
  double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
  for (const Vector3d& v : a.vertices) highest = std::max(highest, n.dot(v));
  for (const Vector3d& v : b.vertices) lowest = std::min(lowest, n.dot(v));
  return lowest - highest;
}

// Returns the largest separation over the faces' normals and the products of edges.
double LargestSeparation(const core::TriangleMesh& a, const core::TriangleMesh& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (int t = 0; t < static_cast<int>(a.triangles.size()); ++t) {
    best = std::max(best, Separation(a, b, core::TriangleAreaVector(a, t).normalized()));
  }
  for (int t = 0; t < static_cast<int>(b.triangles.size()); ++t) {
    best = std::max(best, Separation(a, b, -core::TriangleAreaVector(b, t).normalized()));
  }
  for (const auto& [p, q] : Edges(a)) {
    for (const auto& [r, s] : Edges(b)) {
      const Vector3d normal = (q - p).cross(s - r);
      if (normal.norm() < 1e-9 * (q - p).norm() * (s - r).norm()) continue;
      const Vector3d n = normal.normalized();
      best = std::max({best, Separation(a, b, n), Separation(a, b, -n)});
    }
  }
  return best;
}

// Returns the distance of two segments: where the nearest points of the lines lie in both, theirs;
// otherwise an end is nearest, which the vertices' distances to the surfaces cover.
double LineDistance(const std::array<Vector3d, 2>& one, const std::array<Vector3d, 2>& two) {
  const Vector3d u = one[1] - one[0], v = two[1] - two[0], w = one[0] - two[0];
  const double a = u.dot(u), b = u.dot(v), c = v.dot(v), d = u.dot(w), e = v.dot(w);
  const double area = a * c - b * b;
  if (!(area > 1e-14 * a * c)) return std::numeric_limits<double>::infinity();
  const double s = (b * e - c * d) / area, t = (a * e - b * d) / area;
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::numeric_limits<double>::infinity();
  return (w + s * u - t * v).norm();
}

double FeatureDistance(const core::TriangleMesh& a, const core::TriangleMesh& b) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const double d : geometry::DistancesToSurface(a.vertices, b)) nearest = std::min(nearest, d);
  for (const double d : geometry::DistancesToSurface(b.vertices, a)) nearest = std::min(nearest, d);
  for (const auto& one : Edges(a)) {
    for (const auto& two : Edges(b)) nearest = std::min(nearest, LineDistance(one, two));
  }
  return nearest;
}

double BruteForceDistance(const BodyPair& pair) {
  core::TriangleMesh placed[2] = {pair.mesh[0], pair.mesh[1]};
  for (int k = 0; k < 2; ++k) core::Transform(Eigen::Affine3d(pair.pose[k].matrix()), &placed[k]);
  const double separation = LargestSeparation(placed[0], placed[1]);
  return separation <= 0.0 ? separation : FeatureDistance(placed[0], placed[1]);
}

struct PairKind {
  const char* name;
  BodyPair (*make)(core::Rng& rng);
  bool closed_form;
};

// A pair in the form of each library, made before the time is taken.
struct Query {
  geometry::ConvexShape shape[2];
  const BodyPair* pair = nullptr;
  std::unique_ptr<fcl::CollisionObjectd> object[2];
};

Query MakeQuery(const BodyPair& pair) {
  Query query;
  query.pair = &pair;
  for (int k = 0; k < 2; ++k) {
    query.shape[k].vertices = pair.mesh[k].vertices;
    auto vertices = std::make_shared<std::vector<Vector3d>>(pair.mesh[k].vertices);
    auto faces = std::make_shared<std::vector<int>>();
    for (const Eigen::Vector3i& t : pair.mesh[k].triangles) {
      faces->insert(faces->end(), {3, t[0], t[1], t[2]});
    }
    auto convex = std::make_shared<fcl::Convexd>(
        vertices, static_cast<int>(pair.mesh[k].triangles.size()), faces);
    query.object[k] = std::make_unique<fcl::CollisionObjectd>(convex, pair.pose[k]);
  }
  return query;
}

double Ours(const Query& query) {
  return geometry::SignedDistance(query.shape[0], query.pair->pose[0], query.shape[1],
                                  query.pair->pose[1])
      .distance;
}

double Fcl(const Query& query, fcl::GJKSolverType solver) {
  fcl::DistanceRequestd request(true, true);
  request.gjk_solver_type = solver;
  request.distance_tolerance = 1e-9;
  fcl::DistanceResultd result;
  fcl::distance(query.object[0].get(), query.object[1].get(), request, result);
  return result.min_distance;
}

// FCL 0.7's own GJK (GST_INDEP) is left out: an assertion ends the process on some pairs of boxes.
double FclLibccd(const Query& query) {
  return Fcl(query, fcl::GST_LIBCCD);
}

void PrintRow(const PairKind& kind, const std::vector<Query>& queries, const char* method,
              double (*distance)(const Query&)) {
  std::vector<double> errors;
  int failed = 0;
  const auto start = std::chrono::steady_clock::now();
  std::vector<double> distances;
  for (const Query& query : queries) {
    try {
      distances.push_back(distance(query));
    } catch (const std::exception&) {
      distances.push_back(std::numeric_limits<double>::quiet_NaN());
    }
  }
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const BodyPair& pair = *queries[i].pair;
    const double error = std::abs(distances[i] - pair.distance) / pair.size;
    failed += !(error <= kWrong);
    if (std::isfinite(error)) errors.push_back(error);
  }
  std::sort(errors.begin(), errors.end());
  const auto share = [&](double part) {
    return errors.empty() ? NAN : errors[static_cast<std::size_t>(part * (errors.size() - 1))];
  };
  std::printf("%-8s %6zu %-12s %9.1e %9.1e %9.1e %6d %9.2f\n", kind.name, queries.size(), method,
              share(0.5), share(0.99), share(1.0), failed, 1e6 * passed.count() / queries.size());
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  int count = 500;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--pairs") count = std::max(1, std::atoi(argv[i + 1]));
  }
  const PairKind kinds[] = {{"boxes", Boxes, true},
                            {"stacked", StackedBoxes, true},
                            {"hulls", Hulls, false},
                            {"plates", Plates, false},
                            {"deep", DeepHulls, false}};
  std::printf("%-8s %6s %-12s %9s %9s %9s %6s %9s\n", "pairs", "number", "method", "median", "99 %",
              "largest", "wrong", "us");
  for (const PairKind& kind : kinds) {
    core::Rng rng(11);
    std::vector<BodyPair> pairs;
    int overlapping = 0;
    for (int i = 0; i < count; ++i) {
      pairs.push_back(kind.make(rng));
      BodyPair& pair = pairs.back();
      if (!kind.closed_form) pair.distance = BruteForceDistance(pair);
      pair.size = core::Bounds(pair.mesh[0]).diagonal().norm() +
                  core::Bounds(pair.mesh[1]).diagonal().norm();
      overlapping += pair.distance < 0.0;
    }
    std::vector<Query> queries;
    for (const BodyPair& pair : pairs) queries.push_back(MakeQuery(pair));
    PrintRow(kind, queries, "ours", Ours);
    PrintRow(kind, queries, "FCL, libccd", FclLibccd);
    std::printf("%-8s %d of %d overlap\n", kind.name, overlapping, count);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
