#pragma once

#include <vector>

#include "nn/diffusion_schedule.h"
#include "scene/model/category_diffusion.h"
#include "scene/model/denoiser.h"
#include "scene/model/guidance.h"
#include "scene/model/limited_classes.h"

namespace simwright::scene {

// Clean scenes in the representation of the model.
struct CleanScenes {
  torch::Tensor poses;    // (B x N x 12), each feature in [-1, 1]
  torch::Tensor classes;  // (B x N) int64, 0 .. K - 1
};

// The terms of the loss, means over tokens.
struct SceneLoss {
  torch::Tensor total;
  torch::Tensor translation, rotation;  // mean squared errors of the noise
  torch::Tensor divergence;             // of the class posteriors; continuous: squared error
  torch::Tensor cross_entropy;          // of the clean classes; continuous: 0
};

// Noisy scenes with the training targets of a denoiser.
struct DenoisingBatch {
  CleanScenes clean;
  NoisyScenes noisy;
  torch::Tensor pose_noise;    // (B x N x 12)
  torch::Tensor class_noise;   // (B x N x K), of a continuous model
  torch::Tensor class_weight;  // (B), of the classes' loss, of a mixed model
  TextInput text;              // of a model that reads prompts

  // Returns `count` scenes from `first` on: views, not copies.
  DenoisingBatch Part(std::int64_t first, std::int64_t count) const;
  // Copies the values of a batch of the same shapes, without prompts, into the own tensors, which
  // are made if there are none.
  void CopyFrom(const DenoisingBatch& from);
  // Returns the scenes by the length of their prompts, the shortest first, so that parts of the
  // batch have little padding.
  DenoisingBatch SortedByPromptLength() const;
};

// Options of a denoising step.
struct StepOptions {
  double eta = 1.0;  // share of the posterior's noise that poses receive
  Guidance guidance;
  torch::Tensor forbidden;  // (B x N x K, bool): classes that no clean scene has; undefined: none
  const LimitedClasses* limits = nullptr;  // of a mixed model; null: none
};

// The distribution p(x_previous | x_t) of a denoising step.
struct StepDistribution {
  torch::Tensor pose_mean;            // (B x N x 12)
  torch::Tensor class_mean;           // (B x N x K), of a continuous model
  double deviation = 0.0;             // of poses and continuous classes; 0: they are certain
  torch::Tensor class_probabilities;  // (B x N x K + 1), of a mixed model
  torch::Tensor clean_classes;        // (B x N x K), of a mixed model: those of the clean classes
};

// Mixed diffusion of scenes (Pfaff et al., after Hu et al. 2024): poses by DDPM (linear betas 1e-4
// to 0.02, noise prediction, x_0 clipped to [-1, 1]), classes by mask and replace. In a continuous
// model both by DDPM, with classes as one-hot vectors from -1 to 1.
class SceneDiffusion {
 public:
  SceneDiffusion(const SceneModelOptions& options, int classes);

  // Adds noise at random times T u^p.
  DenoisingBatch AddNoise(const CleanScenes& scenes, const at::Generator& generator) const;
  // Returns the loss (MSE_translation + MSE_rotation) / 2 + w (KL + 5e-4 (2 - t / T) CE(x_0)),
  // where w is options.class_weight divided by the density of t relative to the uniform one; that
  // density is 1 / (p u^(p - 1)).
  SceneLoss Loss(Denoiser* denoiser, const DenoisingBatch& scenes) const;

  // Returns the time steps of sampling, from the last down: `count` of them, evenly spaced.
  std::vector<int> Times(int count) const;

  // Returns pure noise for `count` scenes of `entries` tokens.
  NoisyScenes Noise(int count, int entries, const at::Generator& generator) const;
  // Return a sample of q(x_t | x_0) for all scenes at one t, and the scenes without noise.
  NoisyScenes NoisyAt(const CleanScenes& scenes, int t, const at::Generator& generator) const;
  NoisyScenes WithoutNoise(const CleanScenes& scenes) const;
  // Performs one denoising step from t to `previous` < t (-1: clean).
  void Step(Denoiser* denoiser, int t, int previous, const StepOptions& options,
            const at::Generator& generator, NoisyScenes* scenes) const;
  // Returns the distribution of the step from t to `previous`, given what the denoiser predicts for
  // the scenes at t.
  StepDistribution Distribution(const NoisyScenes& scenes, const Denoised& guess, int t,
                                int previous, const StepOptions& options) const;
  // Samples poses and classes from a distribution.
  void Draw(const StepDistribution& distribution, const at::Generator& generator,
            NoisyScenes* scenes) const;
  // Returns the logarithm of the density of poses and classes, (B), summed over all entries: of
  // normal distributions, for those of a mixed model's classes of their probabilities. A part that
  // is certain has none. Differentiable in the distribution.
  torch::Tensor LogProbability(const StepDistribution& distribution,
                               const NoisyScenes& scenes) const;
  // Returns the clean scenes at the end of sampling. A continuous class is the argmax of those
  // that are not `forbidden`.
  CleanScenes Clean(const NoisyScenes& scenes, const torch::Tensor& forbidden = {}) const;

 private:
  SceneLoss MixedLoss(const Denoised& guess, const DenoisingBatch& scenes) const;
  // Returns classes (B x N) as continuous ones, (B x N x K) of -1 and 1.
  torch::Tensor OneHot(const torch::Tensor& classes) const;

  bool continuous_;
  double class_weight_, time_power_;
  nn::DiffusionSchedule poses_;
  CategoryDiffusion classes_;
};

}  // namespace simwright::scene
