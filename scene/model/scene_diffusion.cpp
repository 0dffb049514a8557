#include "scene/model/scene_diffusion.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "nn/noise.h"
#include "scene/dataset/vocabulary.h"
#include "scene/model/pose_schedule.h"

namespace simwright::scene {
namespace {

constexpr double kCrossEntropyShare = 5e-4;
constexpr double kNoLogit = -1e9;            // of a class without probability
constexpr double kLeastProbability = 1e-30;  // in a logarithm

torch::Tensor NormalLike(const torch::Tensor& like, const at::Generator& generator) {
  return nn::NormalNumbers(like.sizes(), generator).to(like.device());
}

torch::Tensor MeanSquare(const torch::Tensor& x) {
  return x.square().mean();
}

void SetPoseLoss(const torch::Tensor& off, SceneLoss* loss) {
  loss->translation = MeanSquare(off.narrow(-1, 0, 3));
  loss->rotation = MeanSquare(off.narrow(-1, 3, kPoseWidth - 3));
}

}  // namespace

DenoisingBatch DenoisingBatch::Part(std::int64_t first, std::int64_t count) const {
  const auto part = [&](const torch::Tensor& all) {
    return all.defined() ? all.narrow(0, first, count) : all;
  };
  return {{part(clean.poses), part(clean.classes)},
          {part(noisy.poses), part(noisy.classes), part(noisy.time), {}},
          part(pose_noise),
          part(class_noise),
          part(class_weight),
          text.Part(first, count)};
}

void DenoisingBatch::CopyFrom(const DenoisingBatch& from) {
  const auto copy = [](const torch::Tensor& one, torch::Tensor* to) {
    if (!one.defined()) return;
    if (to->defined()) {
      to->copy_(one);
    } else {
      *to = one.clone();
    }
  };
  copy(from.clean.poses, &clean.poses);
  copy(from.clean.classes, &clean.classes);
  copy(from.noisy.poses, &noisy.poses);
  copy(from.noisy.classes, &noisy.classes);
  copy(from.noisy.time, &noisy.time);
  copy(from.pose_noise, &pose_noise);
  copy(from.class_noise, &class_noise);
  copy(from.class_weight, &class_weight);
}

DenoisingBatch DenoisingBatch::SortedByPromptLength() const {
  const torch::Tensor order = text.mask.sum(1).argsort();
  const auto sorted = [&](const torch::Tensor& all) {
    return all.defined() ? all.index_select(0, order) : all;
  };
  return {{sorted(clean.poses), sorted(clean.classes)},
          {sorted(noisy.poses), sorted(noisy.classes), sorted(noisy.time), {}},
          sorted(pose_noise),
          sorted(class_noise),
          sorted(class_weight),
          {sorted(text.pieces), sorted(text.features), sorted(text.mask)}};
}

SceneDiffusion::SceneDiffusion(const SceneModelOptions& options, int classes)
    : continuous_(options.continuous),
      class_weight_(options.class_weight),
      time_power_(options.time_power),
      poses_(PoseSchedule(options.diffusion_steps)),
      classes_(options.diffusion_steps, classes) {}

DenoisingBatch SceneDiffusion::AddNoise(const CleanScenes& scenes,
                                        const at::Generator& generator) const {
  const torch::Device device = scenes.poses.device();
  const torch::Tensor u = nn::UniformNumbers({scenes.poses.size(0)}, generator);
  const torch::Tensor t = (poses_.steps() * u.pow(time_power_)).to(torch::kLong);
  DenoisingBatch batch;
  batch.clean = scenes;
  batch.noisy.time = t.clamp_max(poses_.steps() - 1).to(device);
  batch.class_weight = (class_weight_ * time_power_ * u.pow(time_power_ - 1.0)).to(device);
  batch.pose_noise = NormalLike(scenes.poses, generator);
  batch.noisy.poses = poses_.AddNoise(scenes.poses, batch.pose_noise, batch.noisy.time);
  if (!continuous_) {
    batch.noisy.classes = classes_.AddNoise(scenes.classes, batch.noisy.time, generator);
    return batch;
  }
  const torch::Tensor one_hot = OneHot(scenes.classes);
  batch.class_noise = NormalLike(one_hot, generator);
  batch.noisy.classes = poses_.AddNoise(one_hot, batch.class_noise, batch.noisy.time);
  return batch;
}

torch::Tensor SceneDiffusion::OneHot(const torch::Tensor& classes) const {
  return 2.0 * torch::one_hot(classes, classes_.classes()).to(torch::kFloat) - 1.0;
}

NoisyScenes SceneDiffusion::WithoutNoise(const CleanScenes& scenes) const {
  NoisyScenes clean;
  clean.poses = scenes.poses;
  clean.classes = continuous_ ? OneHot(scenes.classes) : scenes.classes;
  return clean;
}

NoisyScenes SceneDiffusion::NoisyAt(const CleanScenes& scenes, int t,
                                    const at::Generator& generator) const {
  NoisyScenes noisy = WithoutNoise(scenes);
  noisy.time = torch::full({scenes.poses.size(0)}, t, scenes.classes.options());
  const auto add_noise = [&](const torch::Tensor& clean) {
    return poses_.AddNoise(clean, NormalLike(clean, generator), noisy.time);
  };
  noisy.poses = add_noise(noisy.poses);
  noisy.classes = continuous_ ? add_noise(noisy.classes)
                              : classes_.AddNoise(scenes.classes, noisy.time, generator);
  return noisy;
}

SceneLoss SceneDiffusion::Loss(Denoiser* denoiser, const DenoisingBatch& scenes) const {
  NoisyScenes noisy = scenes.noisy;
  if (scenes.text.IsDefined()) noisy.text = denoiser->EncodeText(scenes.text);
  const Denoised guess = denoiser->Predict(noisy);
  if (!continuous_) return MixedLoss(guess, scenes);
  SceneLoss loss;
  SetPoseLoss(guess.pose_noise - scenes.pose_noise, &loss);
  loss.divergence = MeanSquare(guess.classes - scenes.class_noise);
  loss.cross_entropy = torch::zeros_like(loss.divergence);
  loss.total = 0.5 * (loss.translation + loss.rotation) + loss.divergence;
  return loss;
}

SceneLoss SceneDiffusion::MixedLoss(const Denoised& guess, const DenoisingBatch& scenes) const {
  const torch::Tensor &clean = scenes.clean.classes, &t = scenes.noisy.time;
  SceneLoss loss;
  SetPoseLoss(guess.pose_noise - scenes.pose_noise, &loss);
  const torch::Tensor log_clean = torch::log_softmax(guess.classes.to(torch::kFloat), -1);
  const torch::Tensor divergence =
      classes_.Divergence(clean, scenes.noisy.classes, log_clean, t).mean(-1);  // (B)
  loss.divergence = divergence.mean();
  const torch::Tensor entropy =
      -log_clean.gather(-1, clean.unsqueeze(-1)).squeeze(-1).mean(-1);  // (B)
  loss.cross_entropy = entropy.mean();
  const torch::Tensor weight =
      2.0 - (t.to(torch::kFloat) + 1.0) / static_cast<double>(poses_.steps());
  const torch::Tensor classes =
      scenes.class_weight * (divergence + kCrossEntropyShare * weight * entropy);
  loss.total = 0.5 * (loss.translation + loss.rotation) + classes.mean();
  return loss;
}

std::vector<int> SceneDiffusion::Times(int count) const {
  const int steps = poses_.steps();
  if (count < 1 || count > steps) {
    throw core::Error("sampling takes 1 to " + std::to_string(steps) + " steps");
  }
  std::vector<int> times;
  for (int i = count; i > 0; --i) {
    times.push_back(static_cast<int>(static_cast<std::int64_t>(steps) * i / count) - 1);
  }
  return times;
}

NoisyScenes SceneDiffusion::Noise(int count, int entries, const at::Generator& generator) const {
  NoisyScenes scenes;
  scenes.poses = nn::NormalNumbers({count, entries, kPoseWidth}, generator);
  scenes.classes = continuous_ ? nn::NormalNumbers({count, entries, classes_.classes()}, generator)
                               : torch::full({count, entries}, classes_.mask(), torch::kLong);
  return scenes;
}

StepDistribution SceneDiffusion::Distribution(const NoisyScenes& scenes, const Denoised& guess,
                                              int t, int previous,
                                              const StepOptions& options) const {
  StepDistribution distribution;
  distribution.deviation = poses_.StepDeviation(t, previous, options.eta);
  const auto mean = [&](const torch::Tensor& noisy, const torch::Tensor& noise,
                        const torch::Tensor& absent) {
    torch::Tensor clean = poses_.CleanFrom(noisy, noise, scenes.time).clamp(-1.0, 1.0);
    if (absent.defined()) clean = clean.masked_fill(absent, -1.0);
    return poses_.StepMean(noisy, clean, t, previous, options.eta);
  };
  distribution.pose_mean = mean(scenes.poses, guess.pose_noise, {});
  if (continuous_) {
    distribution.class_mean = mean(scenes.classes, guess.classes, options.forbidden);
    return distribution;
  }
  const torch::Tensor logits = options.forbidden.defined()
                                   ? guess.classes.masked_fill(options.forbidden, kNoLogit)
                                   : guess.classes;
  distribution.clean_classes = torch::softmax(logits, -1);
  if (options.limits != nullptr) {
    distribution.clean_classes = options.limits->Tilt(distribution.clean_classes, scenes.classes);
  }
  distribution.class_probabilities =
      classes_.Posterior(scenes.classes, distribution.clean_classes, scenes.time,
                         torch::full_like(scenes.time, previous));
  return distribution;
}

void SceneDiffusion::Draw(const StepDistribution& distribution, const at::Generator& generator,
                          NoisyScenes* scenes) const {
  const auto normal = [&](const torch::Tensor& mean) {
    const torch::Tensor noise = NormalLike(mean, generator);  // drawn for certain parts, too
    return distribution.deviation > 0.0 ? mean + distribution.deviation * noise : mean;
  };
  scenes->poses = normal(distribution.pose_mean);
  scenes->classes = continuous_
                        ? normal(distribution.class_mean)
                        : CategoryDiffusion::Draw(distribution.class_probabilities, generator);
}

torch::Tensor SceneDiffusion::LogProbability(const StepDistribution& distribution,
                                             const NoisyScenes& scenes) const {
  const double deviation = distribution.deviation;
  const auto normal = [&](const torch::Tensor& x, const torch::Tensor& mean) {
    const double constant = std::log(deviation) + 0.5 * std::log(2.0 * M_PI);
    return (-0.5 * ((x - mean) / deviation).square() - constant).sum({1, 2});
  };
  torch::Tensor sum = torch::zeros({scenes.poses.size(0)}, scenes.poses.options());
  if (deviation > 0.0) {
    sum = sum + normal(scenes.poses, distribution.pose_mean);
    if (continuous_) sum = sum + normal(scenes.classes, distribution.class_mean);
  }
  if (continuous_) return sum;
  const torch::Tensor chosen =
      distribution.class_probabilities.gather(-1, scenes.classes.unsqueeze(-1)).squeeze(-1);
  return sum + torch::log(chosen.clamp_min(kLeastProbability)).sum(1);
}

void SceneDiffusion::Step(Denoiser* denoiser, int t, int previous, const StepOptions& options,
                          const at::Generator& generator, NoisyScenes* scenes) const {
  scenes->time =
      torch::full({scenes->poses.size(0)}, t, scenes->classes.options().dtype(torch::kLong));
  const Denoised guess = PredictGuided(denoiser, *scenes, options.guidance);
  const StepDistribution distribution = Distribution(*scenes, guess, t, previous, options);
  const torch::Tensor before = scenes->classes;
  Draw(distribution, generator, scenes);
  if (options.limits == nullptr) return;
  options.limits->Hold(before, distribution.clean_classes, previous < 0, generator,
                       &scenes->classes);
}

CleanScenes SceneDiffusion::Clean(const NoisyScenes& scenes, const torch::Tensor& forbidden) const {
  if (continuous_) {
    const torch::Tensor allowed =
        forbidden.defined() ? scenes.classes.masked_fill(forbidden, kNoLogit) : scenes.classes;
    return {scenes.poses, allowed.argmax(-1)};
  }
  return {scenes.poses, scenes.classes.clamp_max(classes_.classes() - 1)};
}

}  // namespace simwright::scene
