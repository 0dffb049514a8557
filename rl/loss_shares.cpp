#include "rl/loss_shares.h"

#include <vector>

#include "nn/compute.h"

namespace simwright::rl {
namespace {

constexpr std::int64_t kShareRows = 512;

// Adds `weight` times a scalar, if it is defined.
void AddScalar(double weight, const torch::Tensor& scalar, double* sum) {
  if (scalar.defined()) *sum += weight * scalar.item<double>();
}

struct ShareResult {
  torch::autograd::variable_list gradients;
  LossMeans means;
};

ShareResult BackpropagateShare(double weight, const PpoLoss& loss,
                               const std::vector<torch::Tensor>& parameters) {
  ShareResult result;
  result.gradients = torch::autograd::grad({weight * loss.total}, parameters, {}, {}, false,
                                           /*allow_unused=*/true);
  AddScalar(weight, loss.policy, &result.means.policy);
  AddScalar(weight, loss.value, &result.means.value);
  AddScalar(weight, loss.entropy, &result.means.entropy);
  AddScalar(weight, loss.kl, &result.means.kl);
  AddScalar(weight, loss.clipped_share, &result.means.clipped_share);
  return result;
}

}  // namespace

LossMeans BackpropagateInShares(
    const FlatParameters& parameters, std::int64_t rows,
    const std::function<PpoLoss(std::int64_t first, std::int64_t count)>& loss_of) {
  const nn::SingleThreadedLoops loops;
  const nn::SingleThreadedProducts products;
  std::vector<torch::Tensor> leaves;
  for (std::size_t i = 0; i < parameters.size(); ++i) leaves.push_back(parameters[i]);
  const bool on_cpu = parameters.values().device().is_cpu();
  const int shares = on_cpu ? static_cast<int>((rows + kShareRows - 1) / kShareRows) : 1;
  std::vector<ShareResult> results(static_cast<std::size_t>(shares));
  nn::ForEachShare(shares, [&](int i) {
    const nn::Share share = nn::ShareOf(rows, shares, i);
    const double weight = static_cast<double>(share.count) / static_cast<double>(rows);
    results[static_cast<std::size_t>(i)] =
        BackpropagateShare(weight, loss_of(share.first, share.count), leaves);
  });
  const torch::NoGradGuard no_grad;
  torch::Tensor(parameters.gradients()).zero_();
  LossMeans sum;
  for (const ShareResult& result : results) {
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (result.gradients[i].defined()) leaves[i].mutable_grad().add_(result.gradients[i]);
    }
    sum.policy += result.means.policy;
    sum.value += result.means.value;
    sum.entropy += result.means.entropy;
    sum.kl += result.means.kl;
    sum.clipped_share += result.means.clipped_share;
  }
  return sum;
}

}  // namespace simwright::rl
