#include "scene/model/guidance.h"

namespace simwright::scene {

Denoised PredictGuided(Denoiser* denoiser, const NoisyScenes& scenes, const Guidance& guidance) {
  const Denoised prompted = denoiser->PredictParallel(scenes);
  const double w = guidance.weight;
  if (w == 0.0 || !scenes.text.IsDefined()) return prompted;
  NoisyScenes unprompted = scenes;
  const torch::Tensor &features = guidance.no_prompt.features, &mask = guidance.no_prompt.mask;
  const std::int64_t count = scenes.poses.size(0);
  unprompted.text = {features.expand({count, features.size(1), features.size(2)}),
                     mask.expand({count, mask.size(1)})};
  const Denoised free = denoiser->PredictParallel(unprompted);
  return {(1.0 + w) * prompted.pose_noise - w * free.pose_noise,
          (1.0 + w) * prompted.classes - w * free.classes};
}

}  // namespace simwright::scene
