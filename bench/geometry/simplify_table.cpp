// Compares this project's simplification (geometry/simplify.h), its edge collapse alone
// (geometry/edge_collapse.h) and meshoptimizer's meshopt_simplify at an equal number of faces.
//   bench_simplify_table [--share S]
// Columns: the faces; the largest and the mean distance between the surfaces, in both directions
// from 50,000 points each, over the diagonal; the change of the volume; the pairs of intersecting
// faces; whether the mesh is closed and manifold; the time.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <meshoptimizer.h>

#include "bench/geometry/decomposition_shapes.h"
#include "core/error.h"
#include "geometry/edge_collapse.h"
#include "geometry/mesh_validity.h"
#include "geometry/simplify.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"

namespace simwright::bench {
namespace {

constexpr int kSamples = 50000;  // per surface

core::TriangleMesh Ours(const core::TriangleMesh& mesh, int faces) {
  geometry::SimplifyOptions options;
  options.face_budget = faces;
  return geometry::Simplify(mesh, options);
}

core::TriangleMesh CollapseOnly(const core::TriangleMesh& mesh, int faces) {
  return geometry::CollapseEdges(mesh, std::vector<char>(mesh.vertices.size(), 0), faces, 0.0).mesh;
}

core::TriangleMesh Meshoptimizer(const core::TriangleMesh& mesh, int faces) {
  std::vector<float> positions;
  for (const auto& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k]));
  }
  std::vector<unsigned int> indices;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<unsigned int>(t[k]));
  }
  std::vector<unsigned int> kept(indices.size());
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                               mesh.vertices.size(), 3 * sizeof(float),
                               3 * static_cast<std::size_t>(faces), 1.0f, 0u, nullptr));
  core::TriangleMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t i = 0; i + 2 < kept.size(); i += 3) {
    result.triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  }
  return geometry::WithoutUnusedVertices(result);
}

struct Method {
  const char* name;
  core::TriangleMesh (*simplify)(const core::TriangleMesh& mesh, int faces);
};

struct Distances {
  double largest = 0.0, mean = 0.0;

  void Add(const core::TriangleMesh& from, const core::TriangleMesh& to) {
    std::vector<Eigen::Vector3d> points = geometry::SampleSurface(from, kSamples, 3);
    points.insert(points.end(), from.vertices.begin(), from.vertices.end());
    double sum = 0.0;
    for (const double d : geometry::DistancesToSurface(points, to)) {
      largest = std::max(largest, d);
      sum += d;
    }
    mean = std::max(mean, sum / static_cast<double>(points.size()));
  }
};

std::vector<NamedSolid> FineSolids() {
  const auto ripples = [](const Eigen::Vector3d& p) {
    return p.norm() - 0.08 - 0.004 * std::sin(120.0 * p.x()) * std::sin(120.0 * p.z());
  };
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-0.09), Eigen::Vector3d::Constant(0.09));
  core::TriangleMesh gear = Gear(12, .08, .1, .02);
  for (int i = 0; i < 3; ++i) gear = shapes::Subdivided(gear);
  return {{"mug", shapes::Mug(.0015)},
          {"ball", shapes::Icosphere(5)},
          {"torus", shapes::Torus(.1, .03, 160, 64)},
          {"bowl", shapes::Bowl(.08, .005, 160)},
          {"gear", gear},
          {"ripples", shapes::Implicit(box, .002, ripples)}};
}

void PrintRow(const NamedSolid& solid, const Method& method, int faces) {
  const auto start = std::chrono::steady_clock::now();
  const core::TriangleMesh coarse = method.simplify(solid.mesh, faces);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  if (coarse.empty()) {
    std::printf("%-8s %-14s left no face\n", solid.name.c_str(), method.name);
    return;
  }
  Distances distances;
  distances.Add(solid.mesh, coarse);
  distances.Add(coarse, solid.mesh);
  const double diagonal = core::Bounds(solid.mesh).diagonal().norm();
  const geometry::MeshValidity state = geometry::Examine(coarse);
  std::printf("%-8s %-14s %6zu %9.5f %9.5f %8.3f%% %6d %-6s %9.1f\n", solid.name.c_str(),
              method.name, coarse.triangles.size(), distances.largest / diagonal,
              distances.mean / diagonal,
              100.0 * (state.signed_volume / geometry::SignedVolume(solid.mesh) - 1.0),
              state.self_intersections, state.closed && state.manifold ? "yes" : "NO",
              1e3 * passed.count());
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  double share = 0.05;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--share") share = std::atof(argv[i + 1]);
  }
  const Method methods[] = {
      {"ours", Ours}, {"collapse alone", CollapseOnly}, {"meshoptimizer", Meshoptimizer}};
  std::printf("%-8s %-14s %6s %9s %9s %9s %6s %-6s %9s\n", "solid", "method", "faces", "largest",
              "mean", "volume", "cross", "closed", "ms");
  for (const NamedSolid& solid : FineSolids()) {
    std::printf("%-8s %-14s %6zu\n", solid.name.c_str(), "input", solid.mesh.triangles.size());
    const int faces =
        std::max(16, static_cast<int>(share * static_cast<double>(solid.mesh.triangles.size())));
    for (const Method& method : methods) PrintRow(solid, method, faces);
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
