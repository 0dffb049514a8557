#include "steering/post_training/rollout.h"

namespace simwright::steering {

Rollout RollOut(const scene::SceneDiffusion& diffusion, scene::Denoiser* denoiser, int count,
                int entries, int steps, const scene::EncodedText& text, const torch::Device& device,
                const at::Generator& generator) {
  const torch::NoGradGuard no_gradient;
  Rollout rollout;
  rollout.times = diffusion.Times(steps);
  rollout.times.push_back(-1);
  scene::NoisyScenes scenes = diffusion.Noise(count, entries, generator);
  scenes.poses = scenes.poses.to(device);
  scenes.classes = scenes.classes.to(device);
  scenes.text = text;
  for (int i = 0; i < steps; ++i) {
    const int t = rollout.times[static_cast<size_t>(i)];
    const int previous = rollout.times[static_cast<size_t>(i) + 1];
    scenes.time = torch::full({count}, t, scenes.poses.options().dtype(torch::kLong));
    rollout.states.push_back(scenes);
    const scene::StepDistribution distribution =
        diffusion.Distribution(scenes, denoiser->PredictParallel(scenes), t, previous, {});
    diffusion.Draw(distribution, generator, &scenes);
    rollout.log_probabilities.push_back(diffusion.LogProbability(distribution, scenes));
  }
  rollout.states.push_back(scenes);
  return rollout;
}

torch::Tensor StepLogProbability(const scene::SceneDiffusion& diffusion, scene::Denoiser* denoiser,
                                 const Rollout& rollout, int step, std::int64_t first,
                                 std::int64_t count, const scene::EncodedText& text) {
  const auto part = [&](const scene::NoisyScenes& all) {
    return scene::NoisyScenes{all.poses.narrow(0, first, count),
                              all.classes.narrow(0, first, count), all.time.narrow(0, first, count),
                              text};
  };
  const auto at = static_cast<size_t>(step);
  const scene::NoisyScenes scenes = part(rollout.states[at]);
  const scene::StepDistribution distribution = diffusion.Distribution(
      scenes, denoiser->Predict(scenes), rollout.times[at], rollout.times[at + 1], {});
  return diffusion.LogProbability(distribution, part(rollout.states[at + 1]));
}

}  // namespace simwright::steering
