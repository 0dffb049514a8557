// Counts the queries per second of geometry/triangle_tree.h on one thread: tori of triangles,
// with points near the surface (within 2 % of the larger radius) and anywhere in the AABB.
//   bench_tree_queries
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "core/random.h"
#include "geometry/triangle_tree.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::bench {
namespace {

using Eigen::Vector3d;

constexpr int kPoints = 20000;

template <typename Query>
void Report(const char* name, const std::vector<Vector3d>& points, Query query) {
  double most = 0.0;
  long count = 0;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const Vector3d& p : points) count += query(p);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    most = std::max(most, kPoints / taken.count());
  }
  std::printf("  %-28s %6.2f million/s (%ld true)\n", name, 1e-6 * most, count / 5);
}

void Measure(int segments) {
  const core::TriangleMesh mesh = shapes::Torus(1.0, 0.3, 2 * segments, segments);
  const geometry::TriangleTree tree(mesh);
  core::Rng rng(1);
  std::vector<Vector3d> near, anywhere;
  for (int i = 0; i < kPoints; ++i) {
    const Vector3d& v = mesh.vertices[core::UniformIndex(rng, mesh.vertices.size())];
    near.push_back(v + 0.02 * core::Uniform(rng) * core::UniformDirection(rng));
    anywhere.emplace_back(core::Uniform(rng, -1.3, 1.3), core::Uniform(rng, -1.3, 1.3),
                          core::Uniform(rng, -0.3, 0.3));
  }
  const Vector3d direction = Vector3d(0.54, 0.29, 0.79).normalized();
  std::printf("%d triangles\n", tree.size());
  for (const auto* points : {&near, &anywhere}) {
    std::printf(" points %s\n", points == &near ? "near the surface" : "anywhere");
    Report("Closest", *points, [&](const Vector3d& p) { return tree.Closest(p).triangle >= 0; });
    Report("Within 1 %", *points, [&](const Vector3d& p) { return tree.Within(p, 0.01); });
    Report("FirstHit", *points,
           [&](const Vector3d& p) { return tree.FirstHit(p, direction).has_value(); });
  }
}

}  // namespace
}  // namespace simwright::bench

int main() {
  for (const int segments : {16, 64, 256}) simwright::bench::Measure(segments);
  return 0;
}
