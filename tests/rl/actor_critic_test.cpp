// Networks, densities and gradient steps against libtorch's own and against definitions.
#include "rl/actor_critic.h"

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "rl/flat_adam.h"
#include "rl/gaussian_policy.h"
#include "rl/loss_shares.h"
#include "rl/orthogonal_weights.h"
#include "rl/ppo_loss.h"

namespace simwright::rl {
namespace {

constexpr auto kCpu = torch::kCPU;

TEST(OrthogonalWeights, TheShorterSidesVectorsAreOrthogonalAndOfLengthGain) {
  core::Rng rng(1);
  for (const auto& [rows, columns] : {std::pair{7, 20}, {20, 7}, {9, 9}}) {
    const Eigen::MatrixXd w = OrthogonalWeights(rows, columns, 1.5, rng);
    const Eigen::MatrixXd product =
        rows < columns ? Eigen::MatrixXd(w * w.transpose()) : Eigen::MatrixXd(w.transpose() * w);
    const auto n = product.rows();
    EXPECT_LT((product - 2.25 * Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ActorCritic, TheFastForwardPassGivesWhatLibtorchGives) {
  for (const Activation activation : {Activation::kElu, Activation::kTanh}) {
    core::Rng rng(2);
    const ActorCritic networks({11, 3, {32, 16}, activation}, 0.5, rng, kCpu);
    Rows observations = 4.0f * Rows::Random(37, 11), means;
    networks.Actor().Forward(observations, &means);
    const torch::Tensor expected =
        networks.Means(torch::from_blob(observations.data(), {37, 11})).detach();
    const torch::Tensor found = torch::from_blob(means.data(), {37, 3});
    EXPECT_LT((expected - found).abs().max().item<float>(), 1e-6f);
    EXPECT_GT(expected.abs().max().item<float>(), 1e-3f);
    EXPECT_LT(expected.abs().max().item<float>(), 0.5f);  // starts near the middle
    EXPECT_NEAR(networks.Std()[1], 0.5f, 1e-6f);
  }
}

TEST(ActorCritic, GradientsStandInOneRowAndAreTheSlopesOfTheLoss) {
  core::Rng rng(3);
  const ActorCritic networks({4, 2, {8, 6}, Activation::kElu}, 0.5, rng, kCpu);
  const torch::Tensor x = torch::linspace(-1, 1, 20).view({5, 4});
  const auto loss = [&] {
    return networks.Means(x).square().sum() + networks.Values(x).sum() +
           (networks.log_std() * 3.0).sum();
  };
  torch::Tensor values = networks.parameters().values();
  const torch::Tensor gradients = networks.parameters().gradients();
  loss().backward();
  const torch::Tensor found = gradients.clone();
  loss().backward();  // accumulates
  EXPECT_TRUE(torch::allclose(gradients, 2.0 * found));
  const torch::NoGradGuard no_grad;
  for (std::int64_t i = 0; i < values.numel(); i += 3) {
    const float kept = values[i].item<float>();
    values[i] = kept + 1e-2f;
    const double up = loss().item<double>();
    values[i] = kept - 1e-2f;
    const double down = loss().item<double>();
    values[i] = kept;
    ASSERT_NEAR(found[i].item<double>(), (up - down) / 2e-2, 2e-3) << i;
  }
}

TEST(FlatAdam, StepsAsLibtorchsDoes) {
  torch::manual_seed(1);
  const torch::Tensor start = torch::randn({50}), target = torch::randn({50});
  torch::Tensor theirs = start.clone().requires_grad_(true);
  torch::Tensor ours = start.clone();
  torch::optim::Adam optimizer({theirs}, torch::optim::AdamOptions(0.01).eps(1e-5));
  FlatAdam adam(50, 1e-5, kCpu);
  for (int step = 0; step < 200; ++step) {
    optimizer.zero_grad();
    (theirs - target).square().sum().backward();
    optimizer.step();
    adam.Step(2.0 * (ours - target), 0.01, ours);
  }
  EXPECT_LT((ours - theirs).abs().max().item<float>(), 1e-5f);
  EXPECT_GT((ours - start).abs().max().item<float>(), 0.5f);
}

TEST(GaussianPolicy, DrawsHaveTheMomentsAndTheDensityTheyClaim) {
  core::Rng rng(4);
  Rows means(20000, 2), actions;
  means.col(0).setConstant(0.3f);
  means.col(1).setConstant(-2.0f);
  const Eigen::RowVectorXf std{{0.5f, 0.1f}};
  SampleActions(means, std, rng, &actions);
  const Eigen::RowVectorXf found = (actions - means).array().square().colwise().mean().sqrt();
  EXPECT_NEAR(found[0], 0.5f, 0.01f);
  EXPECT_NEAR(found[1], 0.1f, 0.002f);
  EXPECT_NEAR(actions.col(0).mean(), 0.3f, 0.01f);
  // The mean of -log density is the entropy, log(std sqrt(2 pi e)) per dimension.
  const double entropy = std::log(0.5) + std::log(0.1) + std::log(2.0 * M_PI * M_E);
  EXPECT_NEAR(-LogDensity(actions, means, std).mean(), entropy, 0.02);
  // At the mean: 1 / (2 pi std_0 std_1).
  EXPECT_NEAR(LogDensity(means, means, std)[0], -std::log(2.0 * M_PI * 0.5 * 0.1), 1e-5);
}

// Returns a batch that `networks` could have sampled, except for the means, which are shifted by
// `moved`.
Samples SampledBy(const ActorCritic& networks, int count, float moved) {
  core::Rng rng(6);
  Rows x = Rows::Random(count, networks.sizes().observations), means, actions;
  networks.Actor().Forward(x, &means);
  means.array() += moved;
  SampleActions(means, networks.Std(), rng, &actions);
  Eigen::VectorXf density = LogDensity(actions, means, networks.Std());
  const auto tensor = [](Rows& rows) {
    return torch::from_blob(rows.data(), {rows.rows(), rows.cols()}).clone();
  };
  Samples samples;
  samples.observations = tensor(x);
  samples.actions = tensor(actions);
  samples.means = tensor(means);
  samples.log_densities = torch::from_blob(density.data(), {count}).clone();
  samples.values = networks.Values(samples.observations).detach();
  samples.returns = samples.values + 0.5;
  samples.advantages = torch::linspace(-1, 3, count);
  return samples;
}

TEST(PpoLoss, IsThatOfThePaper) {
  core::Rng rng(5);
  const ActorCritic networks({3, 2, {16}, Activation::kTanh}, 0.4, rng, kCpu);
  PpoOptions options;
  const torch::Tensor log_std = networks.log_std().detach().clone();
  Samples unmoved = SampledBy(networks, 4000, 0.0f);
  unmoved.NormalizeAdvantages();
  const PpoLoss same = ComputePpoLoss(networks, unmoved, log_std, options);
  EXPECT_NEAR(same.kl.item<double>(), 0.0, 1e-6);
  EXPECT_NEAR(same.policy.item<double>(), 0.0, 1e-5);  // ratio 1, advantages of mean 0
  EXPECT_NEAR(same.value.item<double>(), 0.125, 1e-6);
  EXPECT_EQ(same.clipped_share.item<double>(), 0.0);
  EXPECT_NEAR(same.entropy.item<double>(), 2.0 * std::log(0.4 * std::sqrt(2.0 * M_PI * M_E)), 1e-5);

  const Samples apart = SampledBy(networks, 4000, 0.2f);
  Samples normalized = apart;
  normalized.NormalizeAdvantages();
  const PpoLoss moved = ComputePpoLoss(networks, normalized, log_std, options);
  // (0.2 / 0.4)^2 / 2 per dimension; and the mean of -log ratio over samples of the old policy.
  EXPECT_NEAR(moved.kl.item<double>(), 0.25, 1e-5);
  double surrogate = 0.0, log_ratio = 0.0;
  const torch::Tensor means = networks.Means(apart.observations).detach();
  const double mean = apart.advantages.mean().item<double>();
  const double spread = apart.advantages.std(false).item<double>();
  for (int i = 0; i < 4000; ++i) {
    const double change =
        ((apart.actions[i] - apart.means[i]).square() - (apart.actions[i] - means[i]).square())
            .sum()
            .item<double>() /
        (2.0 * 0.16);
    const double ratio = std::exp(change), clipped = std::min(1.2, std::max(0.8, ratio));
    const double advantage = (apart.advantages[i].item<double>() - mean) / spread;
    surrogate += std::min(ratio * advantage, clipped * advantage) / 4000.0;
    log_ratio += change / 4000.0;
  }
  EXPECT_NEAR(moved.policy.item<double>(), -surrogate, 1e-4);
  EXPECT_NEAR(-log_ratio, 0.25, 0.03);
  EXPECT_GT(moved.clipped_share.item<double>(), 0.5);
}

TEST(LossShares, GiveTheGradientOfTheWhole) {
  core::Rng rng(5);
  const ActorCritic networks({3, 2, {16}, Activation::kElu}, 0.4, rng, kCpu);
  PpoOptions options;
  const torch::Tensor log_std = networks.log_std().detach().clone();
  Samples batch = SampledBy(networks, 1100, 0.2f);  // three shares of 366 or 367 rows
  batch.NormalizeAdvantages();
  const PpoLoss whole = ComputePpoLoss(networks, batch, log_std, options);
  torch::Tensor gradients = networks.parameters().gradients();
  gradients.zero_();
  whole.total.backward();
  const torch::Tensor expected = gradients.clone();
  const auto loss_of = [&](std::int64_t first, std::int64_t count) {
    return ComputePpoLoss(networks, batch.Rows(first, count), log_std, options);
  };
  core::SetThreadCount(1);
  const LossMeans means = BackpropagateInShares(networks.parameters(), 1100, loss_of);
  EXPECT_GT(expected.norm().item<double>(), 0.1);
  EXPECT_LT((gradients - expected).abs().max().item<double>(), 1e-6);
  EXPECT_NEAR(means.policy, whole.policy.item<double>(), 1e-6);
  EXPECT_NEAR(means.value, whole.value.item<double>(), 1e-6);
  EXPECT_NEAR(means.entropy, whole.entropy.item<double>(), 1e-6);
  EXPECT_NEAR(means.kl, whole.kl.item<double>(), 1e-6);
  EXPECT_NEAR(means.clipped_share, whole.clipped_share.item<double>(), 1e-6);
  const torch::Tensor alone = gradients.clone();
  core::SetThreadCount(3);
  BackpropagateInShares(networks.parameters(), 1100, loss_of);
  core::SetThreadCount(0);
  EXPECT_TRUE(torch::equal(gradients, alone));
}

}  // namespace
}  // namespace simwright::rl
