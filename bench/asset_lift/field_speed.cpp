// How fast the radiance field is.
//   bench_field_speed [--benchmark_filter=REGEX]
// Batches: the hash grid and its network, forward and backward, points along random short rays, on
// all threads; `items_per_second` are points.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "asset_lift/radiance_field.h"
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

// Points as a renderer asks for them: 64 along a ray through the cube's middle.
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

void ForwardBackward(benchmark::State& state, const RadianceFieldOptions& options, bool backward) {
  const RadianceField field(options, 1);
  std::vector<FieldBatch<float>> batches = RayBatches(2048);
  FieldBatchGradient<float> gradient{};
  for (int s = 0; s < kFieldBatch; ++s) {
    gradient.density[s] = 1e-3f;
    for (int c = 0; c < 3; ++c) gradient.color[c][s] = 1e-3f;
  }
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
