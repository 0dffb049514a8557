#include "rl/ppo_loss.h"

#include <cmath>
#include <numbers>

namespace simwright::rl {
namespace {

// KL(old || new) of diagonal Gaussians, mean over the batch.
torch::Tensor GaussianKl(const torch::Tensor& old_means, const torch::Tensor& old_log_std,
                         const torch::Tensor& means, const torch::Tensor& log_std) {
  const torch::Tensor moved = (old_means - means).square().mean(0);
  const torch::Tensor variance = (2.0 * log_std).exp();
  return (log_std - old_log_std + ((2.0 * old_log_std).exp() + moved) / (2.0 * variance) - 0.5)
      .sum();
}

torch::Tensor GaussianEntropy(const torch::Tensor& log_std, std::int64_t actions) {
  return log_std.sum() +
         0.5 * (1.0 + std::log(2.0 * std::numbers::pi)) * static_cast<double>(actions);
}

torch::Tensor ValueLoss(const torch::Tensor& values, const Samples& batch, double clip) {
  const torch::Tensor loss = (values - batch.returns).square();
  if (clip == 0.0) return 0.5 * loss.mean();
  const torch::Tensor clipped = batch.values + (values - batch.values).clamp(-clip, clip);
  return 0.5 * torch::max(loss, (clipped - batch.returns).square()).mean();
}

}  // namespace

Samples Samples::Select(const torch::Tensor& indices) const {
  return {observations.index_select(0, indices), actions.index_select(0, indices),
          means.index_select(0, indices),        log_densities.index_select(0, indices),
          values.index_select(0, indices),       advantages.index_select(0, indices),
          returns.index_select(0, indices)};
}

Samples Samples::Rows(std::int64_t first, std::int64_t count) const {
  return {observations.narrow(0, first, count), actions.narrow(0, first, count),
          means.narrow(0, first, count),        log_densities.narrow(0, first, count),
          values.narrow(0, first, count),       advantages.narrow(0, first, count),
          returns.narrow(0, first, count)};
}

void Samples::NormalizeAdvantages(const AdvantageScale* scale) {
  advantages = scale != nullptr
                   ? (advantages - scale->mean) / (scale->deviation + 1e-8)
                   : (advantages - advantages.mean()) / (advantages.std(/*unbiased=*/false) + 1e-8);
}

PpoLoss ComputePpoLoss(const ActorCritic& networks, const Samples& batch,
                       const torch::Tensor& old_log_std, const PpoOptions& options) {
  const torch::Tensor means = networks.Means(batch.observations);
  const torch::Tensor& log_std = networks.log_std();
  const auto actions = static_cast<double>(batch.actions.size(1));
  const torch::Tensor log_density =
      -0.5 * ((batch.actions - means) * (-log_std).exp()).square().sum(1) - log_std.sum() -
      0.5 * std::log(2.0 * std::numbers::pi) * actions;
  const torch::Tensor ratio = (log_density - batch.log_densities).exp();
  const torch::Tensor clipped = ratio.clamp(1.0 - options.clip, 1.0 + options.clip);
  PpoLoss loss;
  const torch::Tensor policy =
      -torch::min(ratio * batch.advantages, clipped * batch.advantages).mean();
  const torch::Tensor value =
      ValueLoss(networks.Values(batch.observations), batch, options.value_clip);
  const torch::Tensor entropy = GaussianEntropy(log_std, batch.actions.size(1));
  loss.total = policy + options.value_weight * value - options.entropy_weight * entropy;

  const torch::NoGradGuard no_grad;
  loss.policy = policy.detach();
  loss.value = value.detach();
  loss.entropy = entropy.detach();
  loss.kl = GaussianKl(batch.means, old_log_std, means, log_std);
  loss.clipped_share = (ratio != clipped).to(torch::kFloat).mean();
  return loss;
}

PpoLoss ComputeImitationLoss(const ActorCritic& networks, const Demonstrations& shown) {
  const torch::Tensor std = networks.log_std().detach().exp();
  const torch::Tensor off = (networks.Means(shown.observations) - shown.actions) / std;
  PpoLoss loss;
  loss.total = 0.5 * off.square().sum(1).mean();
  return loss;
}

PpoLoss ComputeCriticLoss(const ActorCritic& networks, const Samples& batch,
                          const torch::Tensor& old_log_std, const PpoOptions& options) {
  PpoLoss loss;
  loss.total = options.value_weight *
               ValueLoss(networks.Values(batch.observations), batch, options.value_clip);
  const torch::NoGradGuard no_grad;
  loss.policy = torch::zeros({}, loss.total.options());
  loss.value = loss.total.detach() / options.value_weight;
  loss.entropy = GaussianEntropy(networks.log_std(), batch.actions.size(1));
  loss.kl =
      GaussianKl(batch.means, old_log_std, networks.Means(batch.observations), networks.log_std());
  loss.clipped_share = torch::zeros({}, loss.total.options());
  return loss;
}

}  // namespace simwright::rl
