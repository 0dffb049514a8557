// Measures prompts: the time to draw one from a scene's tokens, with and without its text, and the
// time to read a free text.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "physics_params/wordnet.h"
#include "scene/dataset/tokens.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt_drawing.h"
#include "scene/prompt/prompt_reading.h"
#include "scene/scene_types/scene_types.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

double MicrosecondsSince(Clock::time_point start, int count) {
  return 1e6 * std::chrono::duration<double>(Clock::now() - start).count() / count;
}

// Returns the tokens of the scene with the most objects among 500 samples.
std::vector<float> LargestScene(const scene::Grammar& grammar, const scene::Vocabulary& vocabulary,
                                int* objects) {
  std::vector<scene::SceneObject> largest;
  for (std::uint64_t i = 0; i < 500; ++i) {
    core::Rng rng = core::StreamRng(5, i);
    scene::SceneSample sample = scene::SampleGrammar(grammar, rng);
    if (sample.objects.size() > largest.size()) largest = std::move(sample.objects);
  }
  std::vector<float> tokens(static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()));
  scene::EncodeScene(largest, vocabulary, tokens.data());
  *objects = static_cast<int>(largest.size());
  return tokens;
}

double DrawTime(const scene::Vocabulary& vocabulary, const std::vector<float>& tokens,
                const scene::PromptDrawingOptions& options, bool text, int count) {
  const scene::PromptDrawing drawing(vocabulary, scene::DefaultCategorySizes(), options);
  core::Rng rng(1);
  size_t letters = 0;
  const auto start = Clock::now();
  for (int i = 0; i < count; ++i) {
    const scene::Prompt prompt = drawing.Draw(tokens.data(), rng);
    letters += text ? prompt.Text().size() : prompt.names.size();
  }
  const double time = MicrosecondsSince(start, count);
  if (letters == 0) std::printf("no names were drawn\n");
  return time;
}

void Report(const scene::SceneType& type, int count) {
  const scene::Grammar grammar = type.make(scene::DefaultCategorySizes());
  const scene::Vocabulary vocabulary = VocabularyOf(grammar);
  int objects = 0;
  const std::vector<float> tokens = LargestScene(grammar, vocabulary, &objects);
  scene::PromptDrawingOptions relations;
  relations.count_weight = relations.names_weight = 0.0;
  std::printf("%-18s %8d %9.1f %9.1f %14.1f\n", type.name.c_str(), objects,
              DrawTime(vocabulary, tokens, {}, false, count),
              DrawTime(vocabulary, tokens, {}, true, count),
              DrawTime(vocabulary, tokens, relations, true, count));
}

void ReportReading(int count) {
  const scene::Vocabulary vocabulary =
      VocabularyOf(scene::SceneTypeNamed("pantry_shelf").make(scene::DefaultCategorySizes()));
  const physics_params::WordNet* const wordnet = physics_params::WordNet::Installed();
  const std::string text =
      "A shelf with two apples, three soda cans and a bowl; one apple is left of the bowl.";
  const auto start = Clock::now();
  for (int i = 0; i < count; ++i) scene::ReadPrompt(text, vocabulary, wordnet);
  std::printf("reading a sentence of 18 words: %.0f us\n", MicrosecondsSince(start, count));
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Time to draw and read prompts, one core");
  int count = 20000;
  app.add_option("--count", count, "Prompts per scene type")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("%-18s %8s %9s %9s %14s\n", "type", "objects", "draw us", "and text",
                "relations only");
    for (const simwright::scene::SceneType& type : simwright::scene::SceneTypes()) {
      simwright::Report(type, count);
    }
    simwright::ReportReading(std::max(1, count / 100));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
