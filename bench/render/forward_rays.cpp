// Measures the rays per second of the forward renderer: depth, normal, mask, label of 512 x 512
// pixels, one ray per pixel, on a bumpy ball of about 1k, 10k and 100k triangles that fills most of
// the image.
//   bench_forward_rays
#include <cmath>

#include <benchmark/benchmark.h>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/parallel.h"
#include "render/forward.h"

namespace simwright {
namespace {

// Returns a latitude-longitude ball with bumps: `rings` x 2 rings quads, two triangles each.
core::TexturedMesh BumpyBall(int rings) {
  core::TexturedMesh ball;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = M_PI * (i + 0.5) / (rings + 1.0), turn = 2.0 * M_PI * j / sectors;
      const double r = 0.5 + 0.03 * std::sin(9.0 * polar) * std::cos(7.0 * turn);
      ball.mesh.vertices.emplace_back(r * std::sin(polar) * std::cos(turn),
                                      r * std::sin(polar) * std::sin(turn), r * std::cos(polar));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      ball.mesh.triangles.emplace_back(a, a + sectors, b + sectors);
      ball.mesh.triangles.emplace_back(a, b + sectors, b);
    }
  }
  return ball;
}

// Arguments: triangles (about), threads.
void ForwardBuffers512(benchmark::State& state) {
  const int rings = static_cast<int>(std::lround(std::sqrt(state.range(0) / 4.0)));
  const core::TexturedMesh ball = BumpyBall(rings);
  render::Scene scene;
  scene.Add(&ball);
  scene.Commit();
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 1.8, 0.4, 0.7, 0.61, 512, 512);
  const int threads = core::ThreadCount();
  core::SetThreadCount(static_cast<int>(state.range(1)));
  double covered = 0.0;
  render::ForwardBuffers buffers;
  for (auto _ : state) {
    render::RenderForward(scene, camera, {}, &buffers);
    covered = 0.0;
    for (const float share : buffers.mask) covered += share;
    benchmark::DoNotOptimize(covered);
  }
  core::SetThreadCount(threads);
  state.counters["triangles"] = static_cast<double>(ball.mesh.triangles.size());
  state.counters["covered"] = covered / (512.0 * 512.0);
  state.counters["Mrays/s"] =
      benchmark::Counter(512.0 * 512.0 * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(ForwardBuffers512)
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}})
    ->ArgNames({"triangles", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace simwright
