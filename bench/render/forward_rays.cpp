// Measures the rays per second of the forward renderer: depth, normal, mask, label of 512 x 512
// pixels, one ray per pixel, on a bumpy ball of about 1k, 10k and 100k triangles that fills most of
// the image.
//   bench_forward_rays
#include <cmath>

#include <benchmark/benchmark.h>

#include "bench/render/bumpy_ball.h"
#include "core/camera.h"
#include "core/mesh.h"
#include "core/parallel.h"
#include "render/forward.h"

namespace simwright {
namespace {

// Arguments: triangles (about), threads.
void ForwardBuffers512(benchmark::State& state) {
  const int rings = static_cast<int>(std::lround(std::sqrt(state.range(0) / 4.0)));
  core::TexturedMesh ball;
  ball.mesh = BumpyBall(rings);
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
