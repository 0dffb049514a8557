// Measures the training speed of scene models and its share of the machine's peak: updates and
// scenes per second of each denoiser, the floating-point operations of their matrix products per
// second, those of one large product by libtorch's BLAS, and the processor time of an update.
//   bench_training_speed --entries 34 --batch 128
// On a GPU it prints the updates per second with each measure that was made for one:
//   for batch in 32 512; do bench_training_speed --device cuda --batch $batch --updates 200; done
#include <chrono>
#include <cstdio>
#include <ctime>
#include <utility>

#include <torch/version.h>
#include <CLI/CLI.hpp>

#include "core/device_choice.h"
#include "core/files.h"
#include "core/parallel.h"
#include "nn/captured_work.h"
#include "nn/compute.h"
#include "nn/mixed_precision.h"
#include "nn/noise.h"
#include "nn/prefetcher.h"
#include "nn/trainer.h"
#include "scene/model/scene_diffusion.h"
#include "scene/model/token_tensors.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string size = "tiny", denoiser = "all", device = "cpu";
  int entries = 34, classes = 8, batch = 32, updates = 40;  // of dimsum
  bool whole = false, prefetch = false, measures = false;
};

torch::Device BestCuda() {
  core::ChooseDevice(core::DeviceChoice::kCuda);
  return nn::BestDevice();
}

// Returns the processor time of this process, all threads, s.
double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

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

// The parts of an update that may be as they were, or made for a GPU.
struct Measures {
  bool prefetch = false;      // batches on a thread of their own
  bool device_noise = false;  // noise drawn on the device
  bool fused = false;         // fused kernels of the optimizer, losses not read back
  bool graph = false;         // with `fused`: the update captured as a CUDA graph
};

// A network with all that its updates need.
class Updates {
 public:
  Updates(const scene::SceneModelOptions& model, const Arguments& arguments,
          const torch::Device& device, const Measures& measures)
      : arguments_(arguments),
        device_(device),
        measures_(measures),
        denoiser_(MakeNetwork(model, arguments, device)),
        diffusion_(model, arguments.classes),
        data_(arguments),
        generator_(nn::SeededGenerator(1, device, measures.device_noise)) {
    nn::TrainerOptions training;
    training.steps = 1000;
    training.kernels = measures.fused ? nn::UpdateKernels::kFused : nn::UpdateKernels::kSeparate;
    trainer_ = std::make_unique<nn::Trainer>(denoiser_.get(), training, folder_.path() / "state");
  }

  // Returns the milliseconds of processor time per update that PerSecond took, all threads.
  double processor_ms() const { return 1e3 * processor_seconds_ / arguments_.updates; }

  // Returns the updates per second, after some to warm up.
  double PerSecond() {
    const int warm_up = device_.is_cuda() ? 10 : 2;
    nn::Prefetcher<scene::DenoisingBatch> batches(
        measures_.prefetch, 0, warm_up + arguments_.updates, [&](int) {
          const scene::CleanScenes scenes = data_.Tensors();
          return diffusion_.AddNoise({scenes.poses.to(device_), scenes.classes.to(device_)},
                                     generator_);
        });
    nn::CapturedWork captured(device_, [&] { trainer_->Update(WholeLoss(captured_batch_)); });
    Clock::time_point start;
    double processor_start = 0.0;
    for (int step = 0; step < warm_up + arguments_.updates; ++step) {
      if (step == warm_up) {
        Wait();
        start = Clock::now();
        processor_start = ProcessorSeconds();
      }
      Step(step, batches.Next(), &captured);
    }
    Wait();
    processor_seconds_ = ProcessorSeconds() - processor_start;
    return arguments_.updates / SecondsSince(start);
  }

  const scene::Denoiser& denoiser() const { return *denoiser_; }

 private:
  static std::shared_ptr<scene::Denoiser> MakeNetwork(const scene::SceneModelOptions& model,
                                                      const Arguments& arguments,
                                                      const torch::Device& device) {
    torch::manual_seed(1);
    std::shared_ptr<scene::Denoiser> network = scene::MakeDenoiser(model, arguments.classes);
    network->to(device);
    return network;
  }

  void Wait() const {
    if (device_.is_cuda()) torch::cuda::synchronize();
  }

  torch::Tensor WholeLoss(const scene::DenoisingBatch& batch) {
    const nn::MixedPrecision half(device_, device_.is_cuda());
    return diffusion_.Loss(denoiser_.get(), batch).total;
  }

  void Step(int step, const scene::DenoisingBatch& batch, nn::CapturedWork* captured) {
    if (measures_.graph) {
      captured_batch_.CopyFrom(batch);
      trainer_->SetStep(step);
      return captured->Run();
    }
    if (measures_.fused) return trainer_->Step(step, WholeLoss(batch));
    const int shares = arguments_.whole ? 1 : nn::ShareCount(device_, arguments_.batch);
    trainer_->Step(step, shares, [&](int i) {
      const nn::Share share = nn::ShareOf(arguments_.batch, shares, i);
      return static_cast<double>(share.count) / arguments_.batch *
             WholeLoss(batch.Part(share.first, share.count));
    });
  }

  const Arguments& arguments_;
  torch::Device device_;
  Measures measures_;
  core::TemporaryFolder folder_;
  std::shared_ptr<scene::Denoiser> denoiser_;
  scene::SceneDiffusion diffusion_;
  RandomScenes data_;
  at::Generator generator_;
  std::unique_ptr<nn::Trainer> trainer_;
  scene::DenoisingBatch captured_batch_;
  double processor_seconds_ = 0.0;
};

// Prints the speed of each denoiser on the CPU.
void MeasureDenoisers(const Arguments& arguments) {
  const double peak = Peak();
  std::printf("%d threads, largest product %.1f GFLOP/s\n", core::ThreadCount(), peak * 1e-9);
  std::printf("%-12s %9s %10s %10s %9s %9s %9s\n", "denoiser", "weights", "updates/s", "scenes/s",
              "GFLOP/s", "of peak", "cpu ms");
  const scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(arguments.size);
  for (const auto& [name, one] :
       {std::pair("ours", model), std::pair("midiffusion", model.AsMiDiffusion()),
        std::pair("diffuscene", model.AsDiffuScene())}) {
    if (arguments.denoiser != "all" && arguments.denoiser != name) continue;
    Updates updates(one, arguments, torch::kCPU, {.prefetch = arguments.prefetch});
    const double speed = updates.PerSecond();
    const double flop = FlopOf(one, updates.denoiser(), arguments) * speed;
    std::printf("%-12s %9lld %10.2f %10.0f %9.1f %7.0f %% %9.1f\n", name,
                static_cast<long long>(scene::ParameterCount(updates.denoiser())), speed,
                arguments.batch * speed, flop * 1e-9, 100.0 * flop / peak, updates.processor_ms());
  }
}

// Prints the updates per second of our denoiser with the measures for a GPU: none, one more in each
// line, and all but one.
void MeasureMeasures(const Arguments& arguments, const torch::Device& device) {
  const bool fused = nn::HasFusedUpdate();
  const bool graph = fused && nn::CapturedWork::IsAvailable(device);
  const std::pair<const char*, Measures> rows[] = {
      {"none", {}},
      {"+ batches ahead", {.prefetch = true}},
      {"+ noise on the device", {.prefetch = true, .device_noise = true}},
      {"+ fused updates", {true, true, true}},
      {"+ CUDA graph", {true, true, true, true}},
      {"all, batches in turn", {false, true, true, true}},
      {"all, noise of the CPU", {true, false, true, true}},
      {"fused updates only", {.fused = true}},
      {"CUDA graph of fused updates only", {.fused = true, .graph = true}}};
  const scene::SceneModelOptions model = scene::SceneModelOptions::OfSize(arguments.size);
  std::printf("%s, %d scenes: updates/s (libtorch %s)\n", arguments.size.c_str(), arguments.batch,
              TORCH_VERSION);
  for (const auto& [name, measures] : rows) {
    if ((measures.fused && !fused) || (measures.graph && !graph)) {
      std::printf("  %-34s not in this build\n", name);
      continue;
    }
    const double speed = Updates(model, arguments, device, measures).PerSecond();
    std::printf("  %-34s %8.2f\n", name, speed);
    std::fflush(stdout);
  }
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
  app.add_option("--device", arguments.device, "cpu, or cuda: prints the measures")
      ->capture_default_str()
      ->check(CLI::IsMember({"cpu", "cuda"}));
  app.add_flag("--measures", arguments.measures,
               "Print the updates/s of tiny and base with each measure for a GPU, on a CPU too");
  app.add_flag("--prefetch", arguments.prefetch, "Make the next batch on a thread of its own");
  app.add_option("--updates", arguments.updates, "Timed updates")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    core::SetThreadCount(0);
    nn::PrepareForWork();
    const torch::Device device = arguments.device == "cuda" ? BestCuda() : torch::kCPU;
    if (!device.is_cuda() && !arguments.measures) {
      MeasureDenoisers(arguments);
      return 0;
    }
    const bool sized = app.count("--size") > 0;
    for (const std::string& size : sized ? std::vector<std::string>{arguments.size}
                                         : std::vector<std::string>{"tiny", "base"}) {
      arguments.size = size;
      MeasureMeasures(arguments, device);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
