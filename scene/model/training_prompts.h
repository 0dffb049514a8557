#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "scene/grammar/category_size.h"
#include "scene/model/prompt_encoder.h"
#include "scene/model/training.h"
#include "scene/model/training_data.h"
#include "scene/prompt/prompt_drawing.h"

namespace simwright::scene {

// The prompts of a training: each scene of a batch gets a new one, drawn from its tokens, or, with
// the probability of options.prompt_dropout, the empty one.
class TrainingPrompts {
 public:
  // Learns the word pieces from prompts of the first training scenes, or reads those of the
  // external encoder. Throws core::Error for an encoder that cannot be used.
  TrainingPrompts(const TrainingData& data, const SceneTrainingOptions& options);

  const WordPieces& pieces() const { return *pieces_; }
  const ExternalTextEncoder* encoder() const { return encoder_.get(); }  // null: none
  // Sets the options of a model that reads these prompts.
  void Complete(SceneModelOptions* model) const;

  // Returns prompts for tokens (B x entries x TokenWidth) of a type of the data; with several types
  // they begin with it. `most`: pieces of each.
  TextInput Draw(int type, const std::vector<float>& tokens, int most, core::Rng& rng) const;
  // Returns the encoder's input for given prompts.
  TextInput InputOf(const std::vector<std::string>& prompts, int most) const;

 private:
  // The scenes of a type.
  struct Type {
    std::string name;   // empty: the only type, which prompts do not name
    size_t scene_size;  // numbers per scene
    PromptDrawing drawing;

    std::string Draw(const float* tokens, core::Rng& rng) const;
  };
  std::vector<Type> types_;
  double dropout_;
  std::unique_ptr<ExternalTextEncoder> encoder_;
  std::unique_ptr<WordPieces> pieces_;
};

}  // namespace simwright::scene
