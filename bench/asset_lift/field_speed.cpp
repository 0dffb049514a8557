// Measures the speed of the radiance field.
//   bench_field_speed [--benchmark_filter=REGEX]
// ForwardBackward: the hash grid and its network, points along random short rays, on all threads;
// Kernels: the same on one thread, with each instruction set; View: an image of 64 x 64 rays of 64
// samples each, rendered and backpropagated; Adam: a step over all parameters; Fit: the default
// stage 1 from one view, with an objective that renders a 64-pixel image per step and costs nothing
// itself; Surface: the stage after it. `items_per_second` are points of the field, parameters, or
// steps.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "asset_lift/radiance_field/field_adam.h"
#include "asset_lift/radiance_field/field_fit.h"
#include "asset_lift/radiance_field/field_model.h"
#include "asset_lift/radiance_field/field_surface.h"
#include "asset_lift/radiance_field/field_targets.h"
#include "asset_lift/radiance_field/radiance_field.h"
#include "asset_lift/radiance_field/volume_rendering.h"
#include "core/parallel.h"
#include "core/random.h"

namespace simwright::asset_lift {
namespace {

RadianceFieldOptions Sized(int levels, int log2_table, int hidden, double scale) {
  RadianceFieldOptions options;
  options.grid.levels = levels;
  options.grid.log2_table_size = log2_table;
  options.grid.scale = scale;
  options.hidden = hidden;
  return options;
}

// Returns the points of a renderer: 64 along a ray through the cube's middle.
std::vector<FieldBatch<float>> RayBatches(int count) {
  std::vector<FieldBatch<float>> batches(count);
  core::Rng rng(7);
  for (auto& batch : batches) {
    const Eigen::Vector3d along = core::UniformDirection(rng);
    const Eigen::Vector3d through = 0.4 * core::UniformDirection(rng);
    for (int s = 0; s < kFieldBatch; ++s) {
      const Eigen::Vector3d at = through + along * ((s + core::Uniform(rng)) / 32.0 - 1.0) * 0.6;
      for (int a = 0; a < 3; ++a) batch.position[a][s] = static_cast<float>(at[a]);
    }
  }
  return batches;
}

FieldBatchGradient<float> SomeGradient() {
  FieldBatchGradient<float> gradient{};
  for (int s = 0; s < kFieldBatch; ++s) {
    gradient.density[s] = 1e-3f;
    for (int c = 0; c < 3; ++c) gradient.color[c][s] = 1e-3f;
  }
  return gradient;
}

void ForwardBackward(benchmark::State& state, const RadianceFieldOptions& options, bool backward) {
  const RadianceField field(options, 1);
  std::vector<FieldBatch<float>> batches = RayBatches(2048);
  const FieldBatchGradient<float> gradient = SomeGradient();
  const int threads = core::ThreadCount();
  std::vector<std::vector<float>> sums(threads, std::vector<float>(field.parameters().size()));
  for (auto _ : state) {
    core::ParallelFor(threads, [&](int t) {
      for (std::size_t b = t; b < batches.size(); b += threads) {
        field.Evaluate(&batches[b]);
        if (backward) field.AddGradient(batches[b], gradient, sums[t].data());
      }
    });
    benchmark::DoNotOptimize(sums[0].data());
  }
  state.SetItemsProcessed(state.iterations() * batches.size() * kFieldBatch);
  state.SetLabel(RadianceField::UsesAvx2() ? "AVX2" : "plain x86-64");
}

void Kernels(benchmark::State& state, bool avx2) {
  if (avx2 && !RadianceField::UsesAvx2()) {
    state.SkipWithError("no AVX2 here");
    return;
  }
  const FieldKernels<float> kernels = avx2 ? Avx2FieldKernels<float>() : PlainFieldKernels<float>();
  const RadianceField field(RadianceFieldOptions(), 1);
  std::vector<FieldBatch<float>> batches = RayBatches(512);
  const FieldBatchGradient<float> gradient = SomeGradient();
  std::vector<float> sum(field.parameters().size());
  for (auto _ : state) {
    for (auto& batch : batches) {
      kernels.evaluate(field.Model(), &batch);
      kernels.add_gradient(field.Model(), batch, gradient, sum.data());
    }
    benchmark::DoNotOptimize(sum.data());
  }
  state.SetItemsProcessed(state.iterations() * batches.size() * kFieldBatch);
}
BENCHMARK_CAPTURE(Kernels, avx2, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Kernels, plain, false)->Unit(benchmark::kMillisecond);

void View(benchmark::State& state) {
  RadianceFieldOptions options;
  options.density_scale = 0.1;  // thin: no ray terminates early
  const RadianceField field(options, 1);
  PixelRays pixels;
  pixels.AppendImage(core::OrbitCamera(Eigen::Vector3d::Zero(), 2.0, 0.4, 0.7, 0.35, 64, 64));
  VolumeRenderOptions render;
  render.finest_step = 1e-3;
  VolumeRenderer<float> renderer(render);
  const OccupancyGrid everywhere;
  RayRenderings<float> pictures, gradient;
  gradient.Resize(pixels.rays.size());
  std::fill(gradient.color.begin(), gradient.color.end(), 1e-3f);
  FieldGradient<float> sum;
  std::int64_t samples = 0;
  for (auto _ : state) {
    renderer.Render(field, everywhere, pixels.rays, 1, &pictures);
    renderer.AddGradient(field, gradient, &sum);
    samples += renderer.samples();
  }
  state.SetItemsProcessed(samples);
}
BENCHMARK(View)->Unit(benchmark::kMillisecond)->UseRealTime();

void Adam(benchmark::State& state) {
  RadianceField field(RadianceFieldOptions(), 1);
  FieldGradient<float> gradient;
  gradient.Prepare(field);
  FieldAdam adam;
  for (auto _ : state) {
    gradient.parts[0][0] = 1.0f;
    if (!adam.Step(1e-3, &field, &gradient)) state.SkipWithError("not finite");
  }
  state.SetItemsProcessed(state.iterations() * field.parameters().size());
}
BENCHMARK(Adam)->Unit(benchmark::kMillisecond)->UseRealTime();

// Returns a grey ball of radius 0.15 from one unit away.
ObservedView BallView() {
  ObservedView view;
  constexpr int kSide = 128;
  view.camera = core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, 0.3, -M_PI / 2, 0.5, kSide, kSide);
  view.color = core::FloatImage(kSide, kSide, 3, 0.6f);
  view.opacity = core::FloatImage(kSide, kSide, 1);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector3d along = view.camera.Ray({x + 0.5, y + 0.5}).normalized();
      *view.opacity.At(x, y) = view.camera.position().cross(along).norm() < 0.15 ? 1.0f : 0.0f;
    }
  }
  return view;
}

// An objective that makes each image a little brighter where there is density.
class Brighter : public ImageObjective {
 public:
  core::Camera NextCamera(double, core::Rng* rng) override {
    return core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, core::Uniform(*rng, -0.2, 1.0),
                             core::Uniform(*rng, -M_PI, M_PI), 0.5, 64, 64);
  }
  double Evaluate(const core::Camera&, const ObjectImage& picture, double, core::Rng*,
                  ObjectImage* gradient) override {
    *gradient = picture;
    for (float& x : gradient->color.values) x = x > 0.0f ? -1e-3f : 0.0f;
    return 0.0;
  }
};

FieldFitOptions LiftSized() {
  FieldFitOptions options;
  options.field.half_side = 0.25;
  return options;
}

void Fit(benchmark::State& state) {
  const std::vector<ObservedView> views = {BallView()};
  std::size_t steps = 0;
  for (auto _ : state) {
    Brighter objective;
    steps += FitField(views, &objective, LiftSized(), nullptr).losses.size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(steps));
}
BENCHMARK(Fit)->Unit(benchmark::kSecond)->UseRealTime()->MeasureProcessCPUTime();

void Surface(benchmark::State& state) {
  const std::vector<ObservedView> views = {BallView()};
  FieldFitOptions options = LiftSized();
  options.stages = {{60, 64}};
  const FieldFit fit = FitField(views, nullptr, options, nullptr);
  for (auto _ : state) benchmark::DoNotOptimize(ExtractSurface(fit, views).iou);
}
BENCHMARK(Surface)->Unit(benchmark::kSecond)->UseRealTime()->MeasureProcessCPUTime();

#define FIELD(name, backward, ...)                                       \
  BENCHMARK_CAPTURE(ForwardBackward, name, Sized(__VA_ARGS__), backward) \
      ->Unit(benchmark::kMillisecond)                                    \
      ->UseRealTime()
FIELD(L8_T15_1x32, true, 8, 15, 32, 1.6);
FIELD(L8_T15_1x32_forward, false, 8, 15, 32, 1.6);
FIELD(L8_T14_1x16, true, 8, 14, 16, 1.6);
FIELD(L16_T19_1x64, true, 16, 19, 64, 1.4473);

}  // namespace
}  // namespace simwright::asset_lift

BENCHMARK_MAIN();
