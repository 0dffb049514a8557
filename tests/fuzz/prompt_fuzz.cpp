// Prompts in free text: a prompt or core::Error, nothing else; what is understood reads as itself
// when it is written in the wording of models. The first byte picks the known names.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "physics_params/wordnet.h"
#include "scene/prompt/prompt_reading.h"
#include "scene/prompt/scene_type_words.h"

namespace {

using namespace simwright;

const std::vector<std::string>& KnownNames(bool many) {
  static const std::vector<std::string> few = {"apple", "bowl"};
  static const std::vector<std::string> all = {"apple",
                                               "bowl",
                                               "can",
                                               "cup",
                                               "fork",
                                               "knife",
                                               "large board game",
                                               "mug",
                                               "pear",
                                               "plate",
                                               "slice of toast",
                                               "spoon",
                                               "steamer",
                                               "tea bottle",
                                               "teapot"};
  return many ? all : few;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::vector<std::string>& names = KnownNames((data[0] & 1) != 0);
  const physics_params::WordNet* const wordnet =
      (data[0] & 2) != 0 ? physics_params::WordNet::Installed() : nullptr;
  try {
    scene::TakeSceneType({"dimsum", "pantry_shelf"}, &text);
    const scene::PromptReading read = scene::ReadPrompt(text, names, wordnet);
    std::string error;
    if (!read.prompt.IsValid(&error)) std::abort();
    if (scene::ReadPrompt(read.text, names, wordnet).prompt != read.prompt) std::abort();
  } catch (const core::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
