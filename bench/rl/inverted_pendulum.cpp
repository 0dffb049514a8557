// Counts the samples until PPO balances an inverted pendulum, by seed.
//   bench_inverted_pendulum [--seeds N] [--samples N] [--threads N]
// Every 8192 samples the current policy plays 20 episodes with its mean action. Prints the samples
// until their mean return is 950 of 1000 or more for the first time, the mean return from then on,
// and that of the last 100 episodes of the training itself. CleanRL's ppo_continuous_action reaches
// 963 +- 22 on MuJoCo's InvertedPendulum-v4 within 1M samples (its documentation).
#include "tests/rl/inverted_pendulum.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/parallel.h"
#include "rl/ppo.h"

namespace simwright {
namespace {

constexpr int kPlayed = 20, kEnvironments = 16;
constexpr std::int64_t kPlayEvery = 8192;

rl::PpoOptions Options(std::uint64_t seed) {
  rl::PpoOptions options;
  options.horizon = 128;
  options.minibatch = 512;
  options.hidden = {64, 64};
  options.seed = seed;
  return options;
}

// Returns the mean return over one episode of each of kPlayed environments.
double Play(const rl::Policy& policy) {
  rl::InvertedPendulum environment(kPlayed);
  rl::Rows observations, actions;
  environment.Reset(12345, &observations);
  rl::StepBatch batch;
  std::vector<int> lasted(kPlayed, 0);
  for (int step = 1; step <= rl::InvertedPendulum::kLongest; ++step) {
    policy.Act(observations, &actions);
    environment.Step(actions, &batch);
    for (std::size_t i = 0; i < kPlayed; ++i) {
      if (lasted[i] == 0 && (batch.terminated[i] || batch.truncated[i])) lasted[i] = step;
    }
    observations = batch.observations;
  }
  double sum = 0.0;
  for (const int steps : lasted) sum += steps;
  return sum / kPlayed;
}

void Train(std::uint64_t seed, std::int64_t samples) {
  const auto start = std::chrono::steady_clock::now();
  rl::InvertedPendulum environment(kEnvironments);
  rl::Ppo ppo(&environment, Options(seed));
  rl::OutcomeWindow recent(100);
  std::int64_t solved = 0;
  double sum = 0.0, smallest = 1000.0;
  int played = 0;
  for (std::int64_t next = kPlayEvery; ppo.samples() < samples;) {
    std::vector<rl::Outcome> outcomes;
    ppo.Collect(&outcomes);
    ppo.Update();
    for (const rl::Outcome& outcome : outcomes) recent.Add(outcome);
    if (ppo.samples() < next) continue;
    next += kPlayEvery;
    const double mean = Play(ppo.CurrentPolicy());
    if (solved == 0 && mean >= 950.0) solved = ppo.samples();
    if (solved == 0) continue;
    sum += mean;
    smallest = std::min(smallest, mean);
    ++played;
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("| %d | %lld | %.0f | %.0f | %.0f | %.0f |\n", static_cast<int>(seed),
              static_cast<long long>(solved), played > 0 ? sum / played : 0.0, smallest,
              recent.MeanReward(), seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  int seeds = 5;
  std::int64_t samples = 200000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i];
    if (flag == "--seeds") seeds = std::atoi(argv[i + 1]);
    if (flag == "--samples") samples = std::atoll(argv[i + 1]);
    if (flag == "--threads") simwright::core::SetThreadCount(std::atoi(argv[i + 1]));
  }
  std::printf("| seed | samples to 950 | mean after | least after | last 100 sampled | s |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (int seed = 1; seed <= seeds; ++seed) {
    simwright::Train(static_cast<std::uint64_t>(seed), samples);
  }
}
