// Measures the training speed of scene models and its share of the machine's peak: updates and
// scenes per second of each denoiser, the floating-point operations of their matrix products per
// second, and those of one large product by libtorch's BLAS.
//   bench_training_speed --entries 34 --batch 128
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/files.h"
#include "core/parallel.h"
#include "nn/compute.h"
#include "nn/noise.h"
#include "nn/prefetcher.h"
#include "nn/trainer.h"
#include "scene/model/scene_diffusion.h"
#include "scene/model/token_tensors.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string size = "tiny", denoiser = "all";
  int entries = 34, classes = 8, batch = 32, updates = 40;  // of dimsum
  bool whole = false, prefetch = false;
};

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
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

// A batch of scenes at random, as the stream of a dataset gives them.
class RandomScenes {
 public:
  explicit RandomScenes(const Arguments& arguments) : range_(Filled(-1.0), Filled(1.0)) {
    vocabulary_.entries = arguments.entries;
    vocabulary_.categories.resize(static_cast<size_t>(arguments.classes - 1));
    vocabulary_.welded.resize(vocabulary_.categories.size());
    const std::int64_t tokens = static_cast<std::int64_t>(arguments.batch) * arguments.entries;
    const torch::Tensor classes =
        torch::one_hot(torch::randint(0, arguments.classes, {tokens}, torch::kLong),
                       arguments.classes)
            .to(torch::kFloat);
    const torch::Tensor all =
        torch::cat({torch::rand({tokens, scene::kPoseWidth}) * 2.0 - 1.0, classes}, 1);
    tokens_.assign(all.data_ptr<float>(), all.data_ptr<float>() + all.numel());
  }
  scene::CleanScenes Tensors() const { return scene::TensorsOf(tokens_, vocabulary_, range_); }

 private:
  static std::array<double, scene::kPoseWidth> Filled(double value) {
    std::array<double, scene::kPoseWidth> all;
    all.fill(value);
    return all;
  }

  scene::Vocabulary vocabulary_;
  scene::PoseRange range_;
  std::vector<float> tokens_;
};

void Measure(const char* name, const scene::SceneModelOptions& model, const Arguments& arguments,
             double peak) {
  torch::manual_seed(1);
  const auto denoiser = scene::MakeDenoiser(model, arguments.classes);
  const scene::SceneDiffusion diffusion(model, arguments.classes);
  const core::TemporaryFolder folder;
  nn::TrainerOptions training;
  training.steps = 1000;
  nn::Trainer trainer(denoiser.get(), training, folder.path() / "state.pt");
  const RandomScenes data(arguments);
  const at::Generator generator = nn::SeededGenerator(1, torch::kCPU, false);
  const int shares = arguments.whole ? 1 : nn::ShareCount(torch::kCPU, arguments.batch);
  nn::Prefetcher<scene::DenoisingBatch> batches(
      arguments.prefetch, 0, arguments.updates + 2,
      [&](int) { return diffusion.AddNoise(data.Tensors(), generator); });
  double seconds = 0.0;
  for (int i = -2; i < arguments.updates; ++i) {  // two to warm up
    const auto start = Clock::now();
    const scene::DenoisingBatch batch = batches.Next();
    trainer.Step(i + 2, shares, [&](int at) {
      const nn::Share share = nn::ShareOf(arguments.batch, shares, at);
      return static_cast<double>(share.count) / arguments.batch *
             diffusion.Loss(denoiser.get(), batch.Part(share.first, share.count)).total;
    });
    if (i >= 0) seconds += SecondsSince(start);
  }
  const double flop = FlopOf(model, *denoiser, arguments) * arguments.updates / seconds;
  std::printf("%-12s %9lld %10.2f %10.0f %9.1f %7.0f %%\n", name,
              static_cast<long long>(scene::ParameterCount(*denoiser)), arguments.updates / seconds,
              arguments.batch * arguments.updates / seconds, flop * 1e-9, 100.0 * flop / peak);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  using namespace simwright;
  CLI::App app("Training speed of scene models");
  Arguments arguments;
  app.add_option("--size", arguments.size, "tiny, base or full")->capture_default_str();
  app.add_option("--denoiser", arguments.denoiser, "all, ours, midiffusion or diffuscene")
      ->capture_default_str();
  app.add_option("--entries", arguments.entries, "Entries per scene")->capture_default_str();
  app.add_option("--classes", arguments.classes, "Classes, including the empty one")
      ->capture_default_str();
  app.add_option("--batch", arguments.batch, "Scenes per update")->capture_default_str();
  app.add_flag("--whole", arguments.whole,
               "Use all threads in each product instead of one batch share per thread");
  app.add_flag("--prefetch", arguments.prefetch, "Make the next batch on a thread of its own");
  app.add_option("--updates", arguments.updates, "Timed updates")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    core::SetThreadCount(0);
    nn::PrepareForWork();
    const double peak = Peak();
    std::printf("%d threads, largest product %.1f GFLOP/s\n", core::ThreadCount(), peak * 1e-9);
    std::printf("%-12s %9s %10s %10s %9s %9s\n", "denoiser", "weights", "updates/s", "scenes/s",
                "GFLOP/s", "of peak");
    const scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(arguments.size);
    for (const auto& [name, one] :
         {std::pair("ours", model), std::pair("midiffusion", model.AsMiDiffusion()),
          std::pair("diffuscene", model.AsDiffuScene())}) {
      if (arguments.denoiser != "all" && arguments.denoiser != name) continue;
      Measure(name, one, arguments, peak);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
