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

// Mixed diffusion of scenes (Pfaff et al., after Hu et al. 2024): poses by DDPM (beta 1e-4 to 0.02
// evenly, the noise predicted, x_0 clipped to [-1, 1]), classes by mask and replace. Or, for a
// continuous model, both by DDPM, classes as one-hot vectors from -1 to 1.
class SceneDiffusion {
 public:
  SceneDiffusion(const SceneModelOptions& options, int classes);

  // (MSE_translation + MSE_rotation) / 2 + w (KL + 5e-4 (2 - t / T) CE(x_0)), at random times
  // T u^p; w is options.class_weight over the density of t against the uniform one, p u^(p - 1).
  SceneLoss Loss(Denoiser* denoiser, const CleanScenes& scenes,
                 const at::Generator& generator) const;
  // The same at times t (B).
  SceneLoss LossAt(Denoiser* denoiser, const CleanScenes& scenes, const torch::Tensor& t,
                   const at::Generator& generator) const;

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
  SceneLoss Loss(Denoiser* denoiser, const CleanScenes& scenes, const torch::Tensor& t,
                 const torch::Tensor& class_weight, const at::Generator& generator) const;
  SceneLoss MixedLoss(Denoiser* denoiser, const CleanScenes& scenes, const torch::Tensor& t,
                      const torch::Tensor& class_weight,  // (B)
                      const at::Generator& generator) const;
  SceneLoss ContinuousLoss(Denoiser* denoiser, const CleanScenes& scenes, const torch::Tensor& t,
                           const at::Generator& generator) const;

  bool continuous_;
  double class_weight_, time_power_;
  nn::DiffusionSchedule poses_;
  CategoryDiffusion classes_;
};

}  // namespace simwright::scene
