#pragma once

#include <memory>

#include "nn/torch.h"
#include "scene/model/class_shapes.h"
#include "scene/model/model_options.h"

namespace simwright::scene {

// Scenes on their way to noise.
struct NoisyScenes {
  torch::Tensor poses;    // (B x N x 12), each feature in about [-1, 1]
  torch::Tensor classes;  // mixed: (B x N) int64, 0 .. K, K the mask; continuous: (B x N x K)
  torch::Tensor time;     // (B) int64, 0 .. steps - 1
};

struct Denoised {
  torch::Tensor pose_noise;  // (B x N x 12)
  torch::Tensor classes;     // (B x N x K): mixed: logits of the clean class; continuous: noise
};

// What predicts the noise of scenes' tokens. K counts the empty class, not the mask.
class Denoiser : public torch::nn::Module {
 public:
  // From several threads at once, too.
  virtual Denoised Predict(const NoisyScenes& scenes) = 0;
  // The same, each of the CPU's threads with some of the scenes.
  Denoised PredictInShares(const NoisyScenes& scenes);

  // Throws core::Error where the model has a table of its classes, or for shapes of other numbers.
  void SetShapes(const AssetShapes& shapes);
  // What SetShapes was given, in single precision; throws likewise.
  AssetShapes Shapes() const;

 protected:
  // What knows classes by their shape where `options` say so, registered; else empty.
  ClassShapes RegisterShapes(const SceneModelOptions& options, int classes, std::int64_t entry,
                             std::int64_t exit);

 private:
  ClassShapes shapes_{nullptr};
};

// A network of random weights. Throws core::Error for options that are not valid.
std::shared_ptr<Denoiser> MakeDenoiser(const SceneModelOptions& options, int classes);

std::int64_t ParameterCount(const torch::nn::Module& module);

}  // namespace simwright::scene
