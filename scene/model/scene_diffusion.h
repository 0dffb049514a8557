#pragma once

#include <vector>

#include "nn/diffusion_schedule.h"
#include "scene/model/category_diffusion.h"
#include "scene/model/denoiser.h"

namespace simwright::scene {

// Scenes as the model sees them.
struct CleanScenes {
  torch::Tensor poses;    // (B x N x 12), each feature in [-1, 1]
  torch::Tensor classes;  // (B x N) int64, 0 .. K - 1
};

// The parts of a loss, means over tokens.
struct SceneLoss {
  torch::Tensor total;
  torch::Tensor translation, rotation;  // mean squared errors of the noise
  torch::Tensor divergence;             // of the classes' posteriors; continuous: squared error
  torch::Tensor cross_entropy;          // of the clean classes; continuous: 0
};

// Scenes with noise, and what a denoiser is to guess of them.
struct DenoisingBatch {
  CleanScenes clean;
  NoisyScenes noisy;
  torch::Tensor pose_noise;    // (B x N x 12)
  torch::Tensor class_noise;   // (B x N x K), of a continuous model
  torch::Tensor class_weight;  // (B), of the classes' loss; of a mixed model

  // `count` of them from `first` on: views, no copies.
  DenoisingBatch Part(std::int64_t first, std::int64_t count) const;
};

// Mixed diffusion of scenes (Pfaff et al., after Hu et al. 2024): poses by DDPM (beta 1e-4 to 0.02
// evenly, the noise predicted, x_0 clipped to [-1, 1]), classes by mask and replace. Or, for a
// continuous model, both by DDPM, classes as one-hot vectors from -1 to 1.
class SceneDiffusion {
 public:
  SceneDiffusion(const SceneModelOptions& options, int classes);

  // At random times T u^p.
  DenoisingBatch AddNoise(const CleanScenes& scenes, const at::Generator& generator) const;
  // (MSE_translation + MSE_rotation) / 2 + w (KL + 5e-4 (2 - t / T) CE(x_0)), where w is
  // options.class_weight over the density of t against the uniform one, p u^(p - 1).
  SceneLoss Loss(Denoiser* denoiser, const DenoisingBatch& scenes) const;

  // Times that a draw goes through, from the last down, `count` of them, evenly.
  std::vector<int> Times(int count) const;

  // Pure noise of `count` scenes of `entries` tokens.
  NoisyScenes Noise(int count, int entries, const at::Generator& generator) const;
  // One step from t to `previous` < t (-1: clean), poses with `eta` of the posterior's noise.
  void Step(Denoiser* denoiser, int t, int previous, double eta, const at::Generator& generator,
            NoisyScenes* scenes) const;
  // What noisy scenes have become at the end. A continuous class is the largest.
  CleanScenes Clean(const NoisyScenes& scenes) const;

 private:
  SceneLoss MixedLoss(const Denoised& guess, const DenoisingBatch& scenes) const;

  bool continuous_;
  double class_weight_, time_power_;
  nn::DiffusionSchedule poses_;
  CategoryDiffusion classes_;
};

}  // namespace simwright::scene
