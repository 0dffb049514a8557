#include "rl/ppo_learner.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "core/content_hash.h"
#include "core/error.h"
#include "nn/compute.h"
#include "rl/generalized_advantage.h"
#include "rl/loss_shares.h"
#include "rl/rank_streams.h"

namespace simwright::rl {
namespace {

constexpr std::uint64_t kWeightStream = 0, kShuffleStream = 2;  // 1 samples actions
constexpr std::int64_t kCheckEvery = 10;  // updates between comparisons of the ranks' policies
constexpr std::int64_t kRowsOfThread = 1024, kRowsOfGpu = 8192;  // per evaluation of the critic

core::Rng WeightRng(std::uint64_t seed) {
  return core::StreamRng(seed, kWeightStream);
}

// Returns the share of the variance of `returns` that `values` explains: 1 if they agree, 0 for a
// constant.
double ExplainedVariance(const Samples& samples) {
  const double variance = samples.returns.var(false).item<double>();
  if (variance == 0.0) return 0.0;
  return 1.0 - (samples.returns - samples.values).var(false).item<double>() / variance;
}

// The members that are means over the rows of minibatches.
constexpr double UpdateReport::*kMeans[] = {&UpdateReport::kl, &UpdateReport::policy_loss,
                                            &UpdateReport::value_loss, &UpdateReport::entropy,
                                            &UpdateReport::clipped_share};

void AddMeans(const LossMeans& means, double weight, UpdateReport* report) {
  report->kl += weight * means.kl;
  report->policy_loss += weight * means.policy;
  report->value_loss += weight * means.value;
  report->entropy += weight * means.entropy;
  report->clipped_share += weight * means.clipped_share;
}

// Turns the sums over the minibatches of each rank into means.
void AverageOverRanks(double minibatches, Communicator* ranks, UpdateReport* report) {
  for (double UpdateReport::*mean : kMeans) report->*mean = ranks->Sum(report->*mean) / minibatches;
  report->gradient_norm /= minibatches;
  report->explained_variance = ranks->Sum(report->explained_variance) / ranks->size();
}

}  // namespace

PpoLearner::PpoLearner(const ActorCriticSizes& sizes, const PpoOptions& options,
                       Communicator* ranks)
    : options_(options),
      ranks_(ranks),
      device_(options.cuda ? nn::BestDevice() : torch::Device(torch::kCPU)),
      rng_(core::StreamRng(options.seed, StreamOfRank(kShuffleStream, ranks->rank()))),
      networks_([&] {
        core::Rng rng = WeightRng(options.seed);
        return ActorCritic(sizes, options.initial_std, rng, device_);
      }()),
      adam_(networks_.parameters().values().numel(), options.adam_epsilon, device_),
      learning_rate_(options.learning_rate) {}

torch::Tensor PpoLearner::OnDevice(const Rows& rows) const {
  // from_blob takes a mutable pointer; the data are copied at once.
  return torch::from_blob(const_cast<float*>(rows.data()), {rows.rows(), rows.cols()})
      .to(device_, torch::kFloat, /*non_blocking=*/false, /*copy=*/true);
}

torch::Tensor PpoLearner::OnDevice(const std::vector<float>& numbers) const {
  return torch::from_blob(const_cast<float*>(numbers.data()),
                          {static_cast<std::int64_t>(numbers.size())})
      .to(device_, torch::kFloat, /*non_blocking=*/false, /*copy=*/true);
}

torch::Tensor PpoLearner::Indices(const std::vector<std::int64_t>& rows) const {
  return torch::from_blob(const_cast<std::int64_t*>(rows.data()),
                          {static_cast<std::int64_t>(rows.size())}, torch::kInt64)
      .to(device_, torch::kInt64, /*non_blocking=*/false, /*copy=*/true);
}

std::vector<float> PpoLearner::ValuesOf(const Rows& observations) const {
  const torch::NoGradGuard no_grad;
  const torch::Tensor all = OnDevice(observations);
  std::vector<float> values(static_cast<std::size_t>(all.size(0)));
  const std::int64_t at_once = device_.is_cpu() ? kRowsOfThread : kRowsOfGpu;
  const auto parts = static_cast<int>((all.size(0) + at_once - 1) / at_once);
  const auto evaluate = [&](int i) {
    const nn::Share share = nn::ShareOf(all.size(0), parts, i);
    const torch::Tensor part =
        networks_.Values(all.narrow(0, share.first, share.count)).cpu().contiguous();
    std::copy_n(part.data_ptr<float>(), share.count, values.data() + share.first);
  };
  if (device_.is_cpu()) {
    nn::ForEachShare(parts, evaluate);
  } else {
    for (int i = 0; i < parts; ++i) evaluate(i);
  }
  return values;
}

Samples PpoLearner::Evaluate(const Rollout& rollout) const {
  RewardSequence sequence;
  sequence.steps = rollout.steps;
  sequence.environments = rollout.environments;
  sequence.rewards = rollout.rewards;
  sequence.terminated = rollout.terminated;
  sequence.truncated = rollout.truncated;
  sequence.dropped = rollout.dropped;
  sequence.values = ValuesOf(rollout.observations);
  const std::vector<float> values = sequence.values;
  const std::vector<float> next_values = ValuesOf(rollout.next_observations);
  sequence.values.insert(sequence.values.end(), next_values.begin(), next_values.end());
  sequence.last_values.assign(rollout.rewards.size(), 0.0f);
  const std::vector<float> last_values = ValuesOf(rollout.last_observations);
  for (std::size_t k = 0; k < last_values.size(); ++k) {
    sequence.last_values[rollout.last_rows[k]] = last_values[k];
  }
  const Advantages result = GeneralizedAdvantages(sequence, options_.discount, options_.lambda);
  return {OnDevice(rollout.observations),  OnDevice(rollout.actions), OnDevice(rollout.means),
          OnDevice(rollout.log_densities), OnDevice(values),          OnDevice(result.advantages),
          OnDevice(result.returns)};
}

void PpoLearner::Imitate(const Rollout& rollout, const Samples& samples,
                         const std::vector<std::int64_t>& rows) {
  if (rollout.shown.rows() == 0 || (rows.empty() && ranks_->size() == 1)) {
    shown_ = {};
    return;
  }
  if (!rows.empty()) {
    const torch::Tensor kept = Indices(rows);
    const torch::Tensor observations = samples.observations.index_select(0, kept);
    const torch::Tensor actions = OnDevice(rollout.shown).index_select(0, kept);
    const bool first = !shown_.observations.defined();
    shown_.observations = first ? observations : torch::cat({shown_.observations, observations});
    shown_.actions = first ? actions : torch::cat({shown_.actions, actions});
  }
  UpdateReport ignored;
  for (int step = 0; step < options_.imitation_steps; ++step) {
    Demonstrations sampled;
    if (shown_.observations.defined()) sampled = SampleDemonstrations();
    const std::int64_t count = sampled.actions.defined() ? sampled.actions.size(0) : 0;
    BackpropagateInShares(
        networks_.parameters(), count, [&](std::int64_t first, std::int64_t share) {
          return ComputeImitationLoss(networks_, {sampled.observations.narrow(0, first, share),
                                                  sampled.actions.narrow(0, first, share)});
        });
    TakeGradientStep(1.0 / ranks_->size(), &ignored);
  }
}

Demonstrations PpoLearner::SampleDemonstrations() {
  const int count = (options_.minibatch + ranks_->size() - 1) / ranks_->size();
  std::vector<std::int64_t> rows(static_cast<std::size_t>(count));
  for (std::int64_t& row : rows) row = core::UniformIndex(rng_, shown_.actions.size(0));
  const torch::Tensor sampled = Indices(rows);
  return {shown_.observations.index_select(0, sampled), shown_.actions.index_select(0, sampled)};
}

void PpoLearner::Shuffle(std::vector<std::int64_t>* rows) {
  for (std::size_t i = rows->size(); i > 1; --i) {
    const auto other = core::UniformIndex(rng_, static_cast<std::int64_t>(i));
    std::swap((*rows)[i - 1], (*rows)[static_cast<std::size_t>(other)]);
  }
}

UpdateReport PpoLearner::Update(const Rollout& rollout, bool critic_alone) {
  const nn::SingleThreadedLoops loops;
  const nn::SingleThreadedProducts products;
  const Samples samples = Evaluate(rollout);
  const torch::Tensor old_log_std = networks_.log_std().detach().clone();
  const bool by_ppo = rollout.shown.rows() == 0 && !critic_alone;
  std::vector<std::int64_t> rows;
  for (std::size_t i = 0; i < rollout.dropped.size(); ++i) {
    if (!rollout.dropped[i]) rows.push_back(static_cast<std::int64_t>(i));
  }
  const auto count = static_cast<std::int64_t>(rows.size());
  const auto all = static_cast<std::int64_t>(ranks_->Sum(static_cast<double>(count)));
  if (all == 0) return NothingLearnt();
  const MinibatchShares shares = SharesOf(count, all);
  Imitate(rollout, samples, rows);
  UpdateReport report;
  report.explained_variance = ExplainedVariance(samples);
  for (int epoch = 0; epoch < options_.epochs; ++epoch) {
    Shuffle(&rows);
    const double kl = ranks_->Sum(LearnEpoch(samples, rows, shares, old_log_std, by_ppo, &report));
    if (by_ppo) AdaptRate(kl, /*last=*/epoch + 1 == options_.epochs);
  }
  AverageOverRanks(static_cast<double>(options_.epochs * shares.parts), ranks_, &report);
  report.learning_rate = learning_rate_;
  report.std = networks_.Std().mean();
  if (updates_++ % kCheckEvery == 0) RequireEqualPolicies();
  return report;
}

MinibatchShares PpoLearner::SharesOf(std::int64_t rows, std::int64_t all) const {
  MinibatchShares shares;
  shares.rows = rows;
  // Minibatches of about equal size: a small remainder would normalize its advantages differently.
  shares.parts = std::max<std::int64_t>(1, (all + options_.minibatch / 2) / options_.minibatch);
  std::vector<double> counts;
  for (std::int64_t part = 0; part < shares.parts; ++part) {
    counts.push_back(static_cast<double>(shares.first(part + 1) - shares.first(part)));
  }
  shares.weights = counts;
  ranks_->AllReduceSum(counts.data(), counts.size());
  for (std::size_t part = 0; part < counts.size(); ++part) {
    shares.weights[part] /= std::max(1.0, counts[part]);
  }
  return shares;
}

std::vector<AdvantageScale> PpoLearner::ScalesOf(const torch::Tensor& advantages,
                                                 const MinibatchShares& shares) const {
  std::vector<AdvantageScale> scales;
  if (ranks_->size() == 1) return scales;
  std::vector<double> sums;  // of rows, advantages and squares, by minibatch
  for (std::int64_t part = 0; part < shares.parts; ++part) {
    const std::int64_t first = shares.first(part), count = shares.first(part + 1) - first;
    const torch::Tensor own = advantages.narrow(0, first, count).to(torch::kDouble);
    sums.insert(sums.end(), {static_cast<double>(count), own.sum().item<double>(),
                             own.square().sum().item<double>()});
  }
  ranks_->AllReduceSum(sums.data(), sums.size());
  for (std::size_t i = 0; i < sums.size(); i += 3) {
    const double count = std::max(1.0, sums[i]), mean = sums[i + 1] / count;
    scales.push_back({mean, std::sqrt(std::max(0.0, sums[i + 2] / count - mean * mean))});
  }
  return scales;
}

double PpoLearner::LearnEpoch(const Samples& samples, const std::vector<std::int64_t>& rows,
                              const MinibatchShares& shares, const torch::Tensor& old_log_std,
                              bool by_ppo, UpdateReport* report) {
  const torch::Tensor shuffled = Indices(rows);
  const std::vector<AdvantageScale> scales =
      ScalesOf(samples.advantages.index_select(0, shuffled), shares);
  double kl = 0.0;
  for (std::int64_t part = 0; part < shares.parts; ++part) {
    const std::int64_t first = shares.first(part), count = shares.first(part + 1) - first;
    const auto index = static_cast<std::size_t>(part);
    Samples batch = samples.Select(shuffled.narrow(0, first, count));
    batch.NormalizeAdvantages(scales.empty() ? nullptr : &scales[index]);
    // Without a row of this rank, its gradient is zero, and those of other ranks remain.
    const LossMeans means = BackpropagateInShares(
        networks_.parameters(), count, [&](std::int64_t from, std::int64_t share_rows) {
          const Samples share = batch.Rows(from, share_rows);
          return by_ppo ? ComputePpoLoss(networks_, share, old_log_std, options_)
                        : ComputeCriticLoss(networks_, share, old_log_std, options_);
        });
    const double weight = shares.weights[index];
    AddMeans(means, weight, report);
    kl += weight * means.kl / static_cast<double>(shares.parts);
    TakeGradientStep(weight, report);
  }
  return kl;
}

void PpoLearner::RequireEqualPolicies() const {
  if (ranks_->size() == 1) return;
  const torch::Tensor values = networks_.parameters().values().cpu().contiguous();
  const std::string hash = core::ContentHash(
      {static_cast<const char*>(values.data_ptr()), values.numel() * sizeof(float)});
  const std::vector<std::string> all = ranks_->AllGather(hash);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] == all[0]) continue;
    throw core::Error("the policy of rank " + std::to_string(i) + " differs from that of rank 0",
                      "training", "use machines with the same processors and the same program");
  }
}

UpdateReport PpoLearner::NothingLearnt() const {
  UpdateReport report;
  report.skipped = 1;
  report.learning_rate = learning_rate_;
  report.std = networks_.Std().mean();
  return report;
}

void PpoLearner::AdaptRate(double kl, bool last) {
  if (options_.target_kl == 0.0) return;
  if (kl > 2.0 * options_.target_kl) {
    learning_rate_ = std::max(options_.smallest_rate, learning_rate_ / 1.5);
  } else if (last && kl < 0.5 * options_.target_kl) {
    learning_rate_ = std::min(options_.largest_rate, learning_rate_ * 1.5);
  }
}

void PpoLearner::TakeGradientStep(double weight, UpdateReport* report) {
  const FlatParameters& parameters = networks_.parameters();
  torch::Tensor gradients = parameters.gradients();
  if (ranks_->size() > 1) gradients.mul_(weight);
  SumOverRanks(&gradients);
  const double norm = gradients.norm().item<double>();
  if (!std::isfinite(norm)) {
    ++report->skipped;
    return;
  }
  report->gradient_norm += norm;
  if (norm > options_.gradient_norm) gradients.mul_(options_.gradient_norm / norm);
  adam_.Step(gradients, learning_rate_, parameters.values());
  networks_.ClampStd(options_.smallest_std, options_.largest_std);
}

void PpoLearner::SumOverRanks(torch::Tensor* gradients) const {
  if (ranks_->size() == 1) return;
  torch::Tensor numbers = gradients->cpu();  // the same tensor on the CPU
  ranks_->AllReduceSum(numbers.data_ptr<float>(), static_cast<std::size_t>(numbers.numel()));
  if (!gradients->is_cpu()) gradients->copy_(numbers);
}

LearnerState PpoLearner::SaveState() const {
  std::ostringstream generator;
  generator << rng_;
  return {networks_.parameters().values().cpu().clone(),
          adam_.means().cpu().clone(),
          adam_.squares().cpu().clone(),
          adam_.steps(),
          learning_rate_,
          generator.str(),
          {shown_.observations.defined() ? shown_.observations.cpu().clone() : torch::Tensor(),
           shown_.actions.defined() ? shown_.actions.cpu().clone() : torch::Tensor()}};
}

void PpoLearner::RestoreState(const LearnerState& state) {
  torch::Tensor values = networks_.parameters().values();
  for (const torch::Tensor& tensor :
       {state.parameters, state.gradient_means, state.gradient_squares}) {
    if (!tensor.defined() || !tensor.sizes().equals(values.sizes())) {
      throw core::Error("holds parameters of another network");
    }
  }
  const Demonstrations& shown = state.shown;
  if (shown.observations.defined() &&
      (shown.observations.size(0) < 1 || shown.actions.size(0) != shown.observations.size(0) ||
       shown.observations.size(1) != networks_.sizes().observations ||
       shown.actions.size(1) != networks_.sizes().actions)) {
    throw core::Error("holds demonstrations of another size");
  }
  std::istringstream generator(state.generator);
  if (!(generator >> rng_)) throw core::Error("holds no random generator");
  values.copy_(state.parameters);
  adam_.Restore(state.gradient_means, state.gradient_squares, state.gradient_steps);
  learning_rate_ = state.learning_rate;
  shown_ = {};
  if (shown.observations.defined()) {
    shown_ = {shown.observations.to(device_), shown.actions.to(device_)};
  }
}

}  // namespace simwright::rl
