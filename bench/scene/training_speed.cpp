// Measures the training speed of scene models and its share of the machine's peak: updates and
// scenes per second of each denoiser, the floating-point operations of their matrix products per
// second, those of one large product by libtorch's BLAS, and the processor time of an update.
//   bench_training_speed --entries 34 --batch 128
#include <chrono>
#include <cstdio>
#include <ctime>

#include <CLI/CLI.hpp>

#include "core/files.h"
#include "core/parallel.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "scene/model/scene_diffusion.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string size = "tiny", denoiser;                      // empty: all
  int entries = 34, classes = 8, batch = 32, updates = 40;  // of dimsum
  bool whole = false;
};

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Returns the processor time of all threads.
double ProcessorSeconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Returns the FLOP/s of a product of two square matrices.
double Peak() {
  constexpr std::int64_t kSide = 1536;
  const torch::Tensor a = torch::randn({kSide, kSide}), b = torch::randn({kSide, kSide});
  double best = 0.0;
  for (int i = 0; i < 8; ++i) {
    const auto start = Clock::now();
    torch::mm(a, b);
    best = std::max(best, 2.0 * kSide * kSide * kSide / SecondsSince(start));
  }
  return best;
}

// Returns the floating-point operations of an update's matrix products, three passes (forward, and
// backward to inputs and to weights): two per weight and token, or per weight and scene where a
// layer acts on time alone, and two products of attention per pair of tokens (the U-Net's, linear,
// are left out).
double FlopOf(const scene::SceneModelOptions& model, const scene::Denoiser& denoiser,
              const Arguments& arguments) {
  double token_weights = 0.0, scene_weights = 0.0;
  for (const auto& one : denoiser.named_parameters()) {
    const std::string& name = one.key();
    if (one.value().dim() < 2 || name.ends_with("class.weight")) continue;
    const bool of_time =
        name.find("modulation") != std::string::npos || name.find("time") != std::string::npos ||
        name.find("film") != std::string::npos || name.find("last.") != std::string::npos;
    (of_time ? scene_weights : token_weights) += static_cast<double>(one.value().numel());
  }
  const double tokens = static_cast<double>(arguments.batch) * arguments.entries;
  const double layers = model.double_blocks + model.single_blocks;
  const double attention = model.kind == scene::DenoiserKind::kUnet
                               ? 0.0
                               : 4.0 * layers * model.width * arguments.entries * tokens;
  return 3.0 * (2.0 * token_weights * tokens + 2.0 * scene_weights * arguments.batch + attention);
}

void Measure(const char* name, const scene::SceneModelOptions& model, const Arguments& arguments,
             double peak) {
  if (!arguments.denoiser.empty() && arguments.denoiser != name) return;
  torch::manual_seed(1);
  const auto denoiser = scene::MakeDenoiser(model, arguments.classes);
  const scene::SceneDiffusion diffusion(model, arguments.classes);
  const core::TemporaryFolder folder;
  nn::TrainerOptions training;
  training.steps = 1000;
  nn::Trainer trainer(denoiser.get(), training, folder.path() / "state.pt");
  const scene::CleanScenes scenes{
      torch::rand({arguments.batch, arguments.entries, 12}) * 2.0 - 1.0,
      torch::randint(0, arguments.classes, {arguments.batch, arguments.entries}, torch::kLong)};
  const at::Generator generator = at::detail::createCPUGenerator(1);
  const int shares = arguments.whole ? 1 : nn::ShareCount(torch::kCPU, arguments.batch);
  double seconds = 0.0, processor = 0.0;
  for (int i = -2; i < arguments.updates; ++i) {  // two to warm up
    const auto start = Clock::now();
    const double processor_start = ProcessorSeconds();
    const scene::DenoisingBatch batch = diffusion.AddNoise(scenes, generator);
    trainer.Step(i + 2, shares, [&](int at) {
      const nn::Share share = nn::ShareOf(arguments.batch, shares, at);
      return static_cast<double>(share.count) / arguments.batch *
             diffusion.Loss(denoiser.get(), batch.Part(share.first, share.count)).total;
    });
    if (i < 0) continue;
    seconds += SecondsSince(start);
    processor += ProcessorSeconds() - processor_start;
  }
  const double flop = FlopOf(model, *denoiser, arguments) * arguments.updates / seconds;
  std::printf("%-12s %9lld %10.2f %10.0f %9.1f %7.0f %% %9.1f\n", name,
              static_cast<long long>(scene::ParameterCount(*denoiser)), arguments.updates / seconds,
              arguments.batch * arguments.updates / seconds, flop * 1e-9, 100.0 * flop / peak,
              1e3 * processor / arguments.updates);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  using namespace simwright;
  CLI::App app("Training speed of scene models");
  Arguments arguments;
  app.add_option("--size", arguments.size, "tiny, base or full")->capture_default_str();
  app.add_option("--denoiser", arguments.denoiser, "The only one measured; all by default")
      ->check(CLI::IsMember({"ours", "midiffusion", "diffuscene"}));
  app.add_option("--entries", arguments.entries, "Entries per scene")->capture_default_str();
  app.add_option("--classes", arguments.classes, "Classes, including the empty one")
      ->capture_default_str();
  app.add_option("--batch", arguments.batch, "Scenes per update")->capture_default_str();
  app.add_flag("--whole", arguments.whole,
               "Use all threads in each product instead of one batch share per thread");
  app.add_option("--updates", arguments.updates, "Timed updates")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    core::SetThreadCount(0);
    nn::PrepareForWork();
    const double peak = Peak();
    std::printf("%d threads, largest product %.1f GFLOP/s\n", core::ThreadCount(), peak * 1e-9);
    std::printf("%-12s %9s %10s %10s %9s %9s %9s\n", "denoiser", "weights", "updates/s", "scenes/s",
                "GFLOP/s", "of peak", "core ms");
    const scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(arguments.size);
    Measure("ours", model, arguments, peak);
    Measure("midiffusion", model.AsMiDiffusion(), arguments, peak);
    Measure("diffuscene", model.AsDiffuScene(), arguments, peak);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
