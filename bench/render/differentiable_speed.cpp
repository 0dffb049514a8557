// Measures the milliseconds of a fitting step's rendering and gradients: 128 x 128 pixels, moved
// vertices (refit included), forward and backward of colour, mask and depth, on a bumpy ball.
//   bench_differentiable_speed
// Arguments: triangles (about), samples per pixel side, edge samples, lit with smooth normals.
#include <cmath>

#include <benchmark/benchmark.h>

#include "bench/render/bumpy_ball.h"
#include "core/camera.h"
#include "core/mesh.h"
#include "core/parallel.h"
#include "render/differentiable.h"

namespace simwright {
namespace {

void Step(benchmark::State& state) {
  render::DifferentiableObject object;
  object.mesh = BumpyBall(static_cast<int>(std::lround(std::sqrt(state.range(0) / 4.0))));
  object.vertex_colors.assign(object.mesh.vertices.size(), Eigen::Vector3f(0.7f, 0.5f, 0.3f));
  render::DifferentiableOptions options;
  options.samples_per_side = static_cast<int>(state.range(1));
  options.edge_samples = static_cast<int>(state.range(2));
  options.lit = state.range(3) != 0;
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 1.8, 0.4, 0.7, 0.61, 128, 128);
  render::DifferentiableBuffers gradient;
  gradient.color = core::FloatImage(128, 128, 3, 0.5f);
  gradient.mask = core::FloatImage(128, 128, 1, 1.0f);
  gradient.depth = core::FloatImage(128, 128, 1, -0.25f);
  const std::vector<Eigen::Vector3d> start = object.mesh.vertices;
  std::vector<Eigen::Vector3d> vertices = start;
  render::DifferentiableRenderer renderer({object}, options);
  render::SceneGradients gradients;
  std::uint64_t step = 0;
  for (auto _ : state) {
    const double scale = 1.0 + 0.01 * std::sin(0.3 * static_cast<double>(++step));
    for (std::size_t i = 0; i < start.size(); ++i) vertices[i] = scale * start[i];
    renderer.SetVertices(0, vertices);
    renderer.Render(camera, step);
    gradients.SetZero();
    renderer.Backward(gradient, &gradients);
    benchmark::DoNotOptimize(gradients.objects[0].vertices.data());
  }
  state.counters["triangles"] = static_cast<double>(object.mesh.triangles.size());
  state.counters["threads"] = core::ThreadCount();
}
BENCHMARK(Step)
    ->ArgNames({"triangles", "side", "edges", "lit"})
    ->Args({1000, 2, 4000, 0})
    ->Args({10000, 2, 4000, 0})
    ->Args({100000, 2, 4000, 0})
    ->Args({10000, 2, 4000, 1})
    ->Args({100000, 2, 4000, 1})
    ->Args({10000, 1, 4000, 0})
    ->Args({10000, 4, 4000, 0})
    ->Args({10000, 8, 4000, 0})
    ->Args({10000, 2, 16000, 0})
    ->Args({10000, 2, 64000, 0})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace simwright
