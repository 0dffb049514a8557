#include "scene/model/training_prompts.h"

#include <algorithm>

#include "scene/prompt/scene_type_words.h"

namespace simwright::scene {
namespace {

constexpr int kLearningScenes = 1024;  // scenes of each type whose prompts give the word pieces
constexpr int kPromptsPerScene = 4;
constexpr std::uint64_t kLearningSeed = 0x7072'6f6d'7074;  // the same for every training

}  // namespace

std::string TrainingPrompts::Type::Draw(const float* tokens, core::Rng& rng) const {
  const std::string text = drawing.Draw(tokens, rng).Text();
  return name.empty() ? text : PromptOfSceneType(text, name);
}

TrainingPrompts::TrainingPrompts(const TrainingData& data, const SceneTrainingOptions& options)
    : dropout_(options.prompt_dropout) {
  const bool several = data.types().size() > 1;
  for (const TrainingType& one : data.types()) {
    const Vocabulary& vocabulary = one.vocabulary();
    types_.push_back({several ? vocabulary.type : "",
                      static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()),
                      PromptDrawing(vocabulary, options.sizes)});
  }
  if (!options.text_encoder.empty()) {
    encoder_ = std::make_unique<ExternalTextEncoder>(options.text_encoder);
    pieces_ = std::make_unique<WordPieces>(encoder_->pieces());
    return;
  }
  core::Rng rng = core::StreamRng(kLearningSeed, 0);
  std::vector<std::string> texts;
  for (size_t t = 0; t < types_.size(); ++t) {
    const int count = std::min(data.types()[t].training, kLearningScenes);
    const std::vector<float> tokens = data.types()[t].dataset->Read(0, count);
    for (size_t i = 0; i < static_cast<size_t>(count * kPromptsPerScene); ++i) {
      texts.push_back(types_[t].Draw(&tokens[i / kPromptsPerScene * types_[t].scene_size], rng));
    }
  }
  pieces_ = std::make_unique<WordPieces>(WordPieces::Learn(texts, options.text_pieces));
}

void TrainingPrompts::Complete(SceneModelOptions* model) const {
  model->text_pieces = encoder_ ? 0 : pieces_->size();
  model->text_features = encoder_ ? encoder_->features() : 0;
}

TextInput TrainingPrompts::Draw(int type, const std::vector<float>& tokens, int most,
                                core::Rng& rng) const {
  const Type& one = types_[static_cast<size_t>(type)];
  std::vector<std::string> prompts(tokens.size() / one.scene_size);
  for (size_t i = 0; i < prompts.size(); ++i) {
    if (core::Uniform(rng) >= dropout_) {
      prompts[i] = one.Draw(&tokens[i * one.scene_size], rng);
    } else if (!one.name.empty()) {
      prompts[i] = PromptOfSceneType("", one.name);
    }
  }
  return InputOf(prompts, most);
}

TextInput TrainingPrompts::InputOf(const std::vector<std::string>& prompts, int most) const {
  return TextInputOf(prompts, *pieces_, most, encoder_.get());
}

}  // namespace simwright::scene
