#pragma once

#include "scene/model/denoiser.h"

namespace simwright::scene {

// Classifier-free guidance (Ho and Salimans 2022).
struct Guidance {
  double weight = 0.0;    // w; 0: the prompt's prediction as it is
  EncodedText no_prompt;  // the encoded empty prompt (1 x L x width), if weight is not 0
};

// Returns the prediction for noisy scenes with their prompts, (1 + w) prompted - w unprompted, for
// the noise and for the raw logits of the classes.
Denoised PredictGuided(Denoiser* denoiser, const NoisyScenes& scenes, const Guidance& guidance);

}  // namespace simwright::scene
