#include "scene/model/scene_diffusion.h"

#include <algorithm>

#include "core/error.h"
#include "scene/dataset/vocabulary.h"
#include "scene/model/pose_schedule.h"

namespace simwright::scene {
namespace {

constexpr double kCrossEntropyShare = 5e-4;

// Drawn on the CPU, so that a seed gives the same on every device.
torch::Tensor NormalLike(const torch::Tensor& like, const at::Generator& generator) {
  return torch::randn(like.sizes(), generator, torch::kFloat).to(like.device());
}

torch::Tensor MeanSquare(const torch::Tensor& x) {
  return x.square().mean();
}

void SetPoseLoss(const torch::Tensor& off, SceneLoss* loss) {
  loss->translation = MeanSquare(off.narrow(-1, 0, 3));
  loss->rotation = MeanSquare(off.narrow(-1, 3, kPoseWidth - 3));
}

}  // namespace

SceneDiffusion::SceneDiffusion(const SceneModelOptions& options, int classes)
    : continuous_(options.continuous),
      class_weight_(options.class_weight),
      time_power_(options.time_power),
      poses_(PoseSchedule(options.diffusion_steps)),
      classes_(options.diffusion_steps, classes) {}

SceneLoss SceneDiffusion::Loss(Denoiser* denoiser, const CleanScenes& scenes,
                               const at::Generator& generator) const {
  const torch::Tensor u = torch::rand({scenes.poses.size(0)}, generator, torch::kFloat);
  const torch::Tensor t = (poses_.steps() * u.pow(time_power_)).to(torch::kLong);
  const torch::Tensor weight = class_weight_ * time_power_ * u.pow(time_power_ - 1.0);
  const torch::Device device = scenes.poses.device();
  return Loss(denoiser, scenes, t.clamp_max(poses_.steps() - 1).to(device), weight.to(device),
              generator);
}

SceneLoss SceneDiffusion::LossAt(Denoiser* denoiser, const CleanScenes& scenes,
                                 const torch::Tensor& t, const at::Generator& generator) const {
  const torch::Tensor weight = torch::full({t.size(0)}, class_weight_, scenes.poses.options());
  return Loss(denoiser, scenes, t, weight, generator);
}

SceneLoss SceneDiffusion::Loss(Denoiser* denoiser, const CleanScenes& scenes,
                               const torch::Tensor& t, const torch::Tensor& class_weight,
                               const at::Generator& generator) const {
  return continuous_ ? ContinuousLoss(denoiser, scenes, t, generator)
                     : MixedLoss(denoiser, scenes, t, class_weight, generator);
}

SceneLoss SceneDiffusion::MixedLoss(Denoiser* denoiser, const CleanScenes& scenes,
                                    const torch::Tensor& t, const torch::Tensor& class_weight,
                                    const at::Generator& generator) const {
  const torch::Tensor noise = NormalLike(scenes.poses, generator);
  const torch::Tensor noisy = classes_.AddNoise(scenes.classes, t, generator);
  const Denoised guess = denoiser->Predict({poses_.AddNoise(scenes.poses, noise, t), noisy, t});
  SceneLoss loss;
  SetPoseLoss(guess.pose_noise - noise, &loss);
  const torch::Tensor log_clean = torch::log_softmax(guess.classes.to(torch::kFloat), -1);
  const torch::Tensor divergence =
      classes_.Divergence(scenes.classes, noisy, log_clean, t).mean(-1);  // (B)
  loss.divergence = divergence.mean();
  const torch::Tensor entropy =
      -log_clean.gather(-1, scenes.classes.unsqueeze(-1)).squeeze(-1).mean(-1);  // (B)
  loss.cross_entropy = entropy.mean();
  const torch::Tensor weight =
      2.0 - (t.to(torch::kFloat) + 1.0) / static_cast<double>(poses_.steps());
  const torch::Tensor classes = class_weight * (divergence + kCrossEntropyShare * weight * entropy);
  loss.total = 0.5 * (loss.translation + loss.rotation) + classes.mean();
  return loss;
}

SceneLoss SceneDiffusion::ContinuousLoss(Denoiser* denoiser, const CleanScenes& scenes,
                                         const torch::Tensor& t,
                                         const at::Generator& generator) const {
  const torch::Tensor one_hot =
      2.0 * torch::one_hot(scenes.classes, classes_.classes()).to(torch::kFloat) - 1.0;
  const torch::Tensor pose_noise = NormalLike(scenes.poses, generator);
  const torch::Tensor class_noise = NormalLike(one_hot, generator);
  const Denoised guess = denoiser->Predict(
      {poses_.AddNoise(scenes.poses, pose_noise, t), poses_.AddNoise(one_hot, class_noise, t), t});
  SceneLoss loss;
  SetPoseLoss(guess.pose_noise - pose_noise, &loss);
  loss.divergence = MeanSquare(guess.classes - class_noise);
  loss.cross_entropy = torch::zeros_like(loss.divergence);
  loss.total = 0.5 * (loss.translation + loss.rotation) + loss.divergence;
  return loss;
}

std::vector<int> SceneDiffusion::Times(int count) const {
  const int steps = poses_.steps();
  if (count < 1 || count > steps) {
    throw core::Error("a draw takes 1 to " + std::to_string(steps) + " steps");
  }
  std::vector<int> times;
  for (int i = count; i > 0; --i) {
    times.push_back(static_cast<int>(static_cast<std::int64_t>(steps) * i / count) - 1);
  }
  return times;
}

NoisyScenes SceneDiffusion::Noise(int count, int entries, const at::Generator& generator) const {
  NoisyScenes scenes;
  scenes.poses = torch::randn({count, entries, kPoseWidth}, generator, torch::kFloat);
  scenes.classes =
      continuous_ ? torch::randn({count, entries, classes_.classes()}, generator, torch::kFloat)
                  : torch::full({count, entries}, classes_.mask(), torch::kLong);
  return scenes;
}

void SceneDiffusion::Step(Denoiser* denoiser, int t, int previous, double eta,
                          const at::Generator& generator, NoisyScenes* scenes) const {
  scenes->time =
      torch::full({scenes->poses.size(0)}, t, scenes->classes.options().dtype(torch::kLong));
  const Denoised guess = denoiser->Predict(*scenes);
  const auto advance = [&](const torch::Tensor& noisy, const torch::Tensor& noise) {
    const torch::Tensor clean = poses_.CleanFrom(noisy, noise, scenes->time).clamp(-1.0, 1.0);
    return poses_.StochasticStep(noisy, clean, t, previous, eta, NormalLike(noisy, generator));
  };
  scenes->poses = advance(scenes->poses, guess.pose_noise);
  if (continuous_) {
    scenes->classes = advance(scenes->classes, guess.classes);
    return;
  }
  const torch::Tensor posterior =
      classes_.Posterior(scenes->classes, torch::softmax(guess.classes, -1), scenes->time,
                         torch::full_like(scenes->time, previous));
  scenes->classes = CategoryDiffusion::Draw(posterior, generator);
}

CleanScenes SceneDiffusion::Clean(const NoisyScenes& scenes) const {
  if (continuous_) return {scenes.poses, scenes.classes.argmax(-1)};
  return {scenes.poses, scenes.classes.clamp_max(classes_.classes() - 1)};
}

}  // namespace simwright::scene
