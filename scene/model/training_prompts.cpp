#include "scene/model/training_prompts.h"

#include <algorithm>

namespace simwright::scene {
namespace {

constexpr int kLearningScenes = 1024;  // scenes whose prompts give the word pieces
constexpr int kPromptsPerScene = 4;
constexpr std::uint64_t kLearningSeed = 0x7072'6f6d'7074;  // the same for every training

}  // namespace

TrainingPrompts::TrainingPrompts(const SceneDataset& dataset, int training_scenes,
                                 const SceneTrainingOptions& options)
    : scene_size_(static_cast<size_t>(dataset.vocabulary().entries) *
                  static_cast<size_t>(dataset.vocabulary().TokenWidth())),
      drawing_(dataset.vocabulary(), options.sizes),
      dropout_(options.prompt_dropout) {
  if (!options.text_encoder.empty()) {
    encoder_ = std::make_unique<ExternalTextEncoder>(options.text_encoder);
    pieces_ = std::make_unique<WordPieces>(encoder_->pieces());
    return;
  }
  const int count = std::min(training_scenes, kLearningScenes);
  const std::vector<float> tokens = dataset.Read(0, count);
  core::Rng rng = core::StreamRng(kLearningSeed, 0);
  std::vector<std::string> texts;
  for (size_t i = 0; i < static_cast<size_t>(count * kPromptsPerScene); ++i) {
    texts.push_back(drawing_.Draw(&tokens[i / kPromptsPerScene * scene_size_], rng).Text());
  }
  pieces_ = std::make_unique<WordPieces>(WordPieces::Learn(texts, options.text_pieces));
}

void TrainingPrompts::Complete(SceneModelOptions* model) const {
  model->text_pieces = encoder_ ? 0 : pieces_->size();
  model->text_features = encoder_ ? encoder_->features() : 0;
}

TextInput TrainingPrompts::Draw(const std::vector<float>& tokens, int most, core::Rng& rng) const {
  std::vector<std::string> prompts(tokens.size() / scene_size_);
  for (size_t i = 0; i < prompts.size(); ++i) {
    if (core::Uniform(rng) < dropout_) continue;
    prompts[i] = drawing_.Draw(&tokens[i * scene_size_], rng).Text();
  }
  return InputOf(prompts, most);
}

TextInput TrainingPrompts::InputOf(const std::vector<std::string>& prompts, int most) const {
  return TextInputOf(prompts, *pieces_, most, encoder_.get());
}

}  // namespace simwright::scene
