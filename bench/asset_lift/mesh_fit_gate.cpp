// Fits meshes to 16 images (masks and colours, 128 x 128) with known cameras: the distance of the
// result from the true surface, and the time.
//   bench_mesh_fit_gate [NAME] [VIEWS] [PIXELS]
// Initial shapes: a sphere; the true surface wrapped coarsely (alpha 1/15, offset 1/60 of the
// diagonal); the visual hull; the hull carved by colour.
// Chamfer: mean of the two mean nearest distances, 20000 points each, over the diagonal.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <string>

#include "asset_lift/mesh_fit/mesh_fit.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "bench/asset_lift/fit_shapes.h"
#include "core/parallel.h"
#include "geometry/alpha_wrap.h"
#include "geometry/mesh_validity.h"

namespace simwright {
namespace {

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void Fit(const FitShape& shape, const std::string& from, int count, int size) {
  const std::vector<asset_lift::ObservedView> views = PatternedViews(shape.mesh, count, size);
  const double diagonal = core::Bounds(shape.mesh).diagonal().norm();
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t clock = std::clock();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  asset_lift::MeshFitOptions options;
  core::TriangleMesh start;
  if (from == "sphere") {
    start = SphereAbout(views);
  } else {
    options.first_edge_ratio = 0.03;
    options.last_edge_ratio = 0.015;
    if (from == "wrap") {
      geometry::AlphaWrapOptions wrap;
      wrap.alpha_ratio = 1.0 / 15.0;
      wrap.offset_ratio = 1.0 / 60.0;
      start = geometry::AlphaWrap(shape.mesh, wrap);
    } else {
      asset_lift::VisualHullOptions hull;
      if (from == "carved") hull.color_tolerance = 0.1;
      start = asset_lift::VisualHull(views, hull);
    }
  }
  const double started = seconds();
  const asset_lift::MeshFitResult result =
      asset_lift::FitMesh(start, views, nullptr, options, nullptr);
  const double took = seconds();
  const double processor = static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC;
  const geometry::MeshValidity sound = geometry::Examine(result.mesh);
  std::printf("%-13s %-7s %6zu  %7.3f%%  %7.3f%%   %.4f   %.4f  %6.1f  %6.1f  %6.1f  %s\n",
              shape.name.c_str(), from.c_str(), result.mesh.triangles.size(),
              100.0 * Chamfer(start, shape.mesh) / diagonal,
              100.0 * Chamfer(result.mesh, shape.mesh) / diagonal, Mean(result.mask_iou),
              Mean(result.color_error), started, took, processor,
              geometry::Describe(sound).c_str());
  for (const core::Finding& finding : result.findings) {
    std::printf("    %s: %s\n", finding.code.c_str(), finding.sentence.c_str());
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  using namespace simwright;
  const std::string only = argc > 1 ? argv[1] : "";
  const int count = argc > 2 ? std::atoi(argv[2]) : 16, size = argc > 3 ? std::atoi(argv[3]) : 128;
  std::printf("%d views of %d x %d, %d threads\n", count, size, size, core::ThreadCount());
  std::printf("%-13s %-7s %6s  %8s  %8s   %6s   %6s  %6s  %6s  %6s\n", "shape", "from", "faces",
              "start", "Chamfer", "IoU", "colour", "start s", "all s", "CPU s");
  for (const FitShape& shape : FitShapes()) {
    if (!only.empty() && only != shape.name) continue;
    for (const std::string& from : shape.starts) Fit(shape, from, count, size);
  }
  return 0;
}
