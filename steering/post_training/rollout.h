#pragma once

#include <vector>

#include "scene/model/scene_diffusion.h"

namespace simwright::steering {

// A batch of sampled scenes with all their noisy states: the trajectory of a policy whose actions
// are the denoising steps (Black et al. 2024, DDPO).
struct Rollout {
  std::vector<int> times;                        // (S + 1), descending; the last is -1
  std::vector<scene::NoisyScenes> states;        // (S + 1) of B scenes: at each of the times
  std::vector<torch::Tensor> log_probabilities;  // (S) of (B): of the step from each of the times

  int Steps() const { return static_cast<int>(times.size()) - 1; }
};

// Samples `count` scenes of `entries` tokens in `steps` denoising steps with the noise of the
// posterior (eta 1). `text`: an encoded prompt for each scene, or undefined.
Rollout RollOut(const scene::SceneDiffusion& diffusion, scene::Denoiser* denoiser, int count,
                int entries, int steps, const scene::EncodedText& text, const torch::Device& device,
                const at::Generator& generator);

// Returns the logarithm of the probability (B) with which the denoiser takes step `step` of a
// rollout, for scenes first .. first + count - 1 of it. Differentiable in the denoiser's weights;
// runs on the calling thread.
torch::Tensor StepLogProbability(const scene::SceneDiffusion& diffusion, scene::Denoiser* denoiser,
                                 const Rollout& rollout, int step, std::int64_t first,
                                 std::int64_t count, const scene::EncodedText& text);

}  // namespace simwright::steering
