#pragma once

#include <memory>

#include "nn/torch.h"
#include "scene/model/class_shapes.h"
#include "scene/model/model_options.h"
#include "scene/model/text_encoder.h"

namespace simwright::scene {

// Noisy scenes of a diffusion.
struct NoisyScenes {
  torch::Tensor poses;    // (B x N x 12), each feature in about [-1, 1]
  torch::Tensor classes;  // mixed: (B x N) int64, 0 .. K, K the mask; continuous: (B x N x K)
  torch::Tensor time;     // (B) int64, 0 .. steps - 1
  EncodedText text = {};  // of a model that reads prompts
};

struct Denoised {
  torch::Tensor pose_noise;  // (B x N x 12)
  torch::Tensor classes;     // (B x N x K): mixed: logits of the clean class; continuous: noise
};

// A network that predicts the noise of scene tokens. K counts the empty class, not the mask.
class Denoiser : public torch::nn::Module {
 public:
  // Predicts the noise. Thread-safe.
  virtual Denoised Predict(const NoisyScenes& scenes) = 0;
  // Predicts the noise with the batch split over the CPU's threads.
  Denoised PredictParallel(const NoisyScenes& scenes);

  // Encodes prompts for NoisyScenes::text. Thread-safe. Throws core::Error if the model reads no
  // prompts, or as TextEncoder does.
  EncodedText EncodeText(const TextInput& text);

  // Sets the class shapes. Throws core::Error if the model uses a table of classes, or for shapes
  // of another size.
  void SetShapes(const AssetShapes& shapes);
  // Returns the shapes of SetShapes, in single precision; throws like it.
  AssetShapes Shapes() const;

 protected:
  // Registers and returns the shape embedding if `options` ask for one; otherwise returns an empty
  // holder.
  ClassShapes RegisterShapes(const SceneModelOptions& options, int classes, std::int64_t entry,
                             std::int64_t exit);
  // Registers the text encoder if `options` ask for one.
  void RegisterText(const SceneModelOptions& options);

 private:
  TextEncoder text_{nullptr};
  ClassShapes shapes_{nullptr};
};

// Returns a network of random weights. Throws core::Error for invalid options.
std::shared_ptr<Denoiser> MakeDenoiser(const SceneModelOptions& options, int classes);

std::int64_t ParameterCount(const torch::nn::Module& module);

}  // namespace simwright::scene
