// Samples each scene grammar: objects per scene (including furniture, before physics), and scenes
// per second.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "scene/grammar/scene_sample.h"
#include "scene/scene_types/scene_types.h"

namespace simwright {
namespace {

void Report(const scene::SceneType& type, int count, std::uint64_t seed) {
  const scene::Grammar grammar = type.make(scene::DefaultCategorySizes());
  double sum = 0.0, derivations = 0.0;
  size_t most = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    const scene::SceneSample sample = scene::SampleGrammar(grammar, rng);
    sum += static_cast<double>(sample.objects.size());
    derivations += sample.derivations;
    most = std::max(most, sample.objects.size());
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%-18s %6.1f %6zu %6d %13.1f %11.0f\n", type.name.c_str(), sum / count, most,
              type.entries, derivations / count, count / seconds);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Scene grammars: objects per scene and scenes per second, one core");
  int count = 2000;
  std::uint64_t seed = 77;
  app.add_option("--count", count, "Scenes per type")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", seed, "Seed of the scenes")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%-18s %6s %6s %6s %13s %11s\n", "type", "mean", "most", "limit", "derivations",
                "scenes/s");
    for (const simwright::scene::SceneType& type : simwright::scene::SceneTypes()) {
      simwright::Report(type, count, seed);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
