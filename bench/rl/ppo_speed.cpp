// Measures the speed of inference and of learning with the default networks.
//   bench_ppo_speed [--threads N] [--observations N] [--actions N]
// Inference: one batch of 64 observations. Learning: whole updates with the default options on 64 x
// 64 samples; a sample counts once per epoch.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/parallel.h"
#include "core/random.h"
#include "rl/ppo.h"

namespace simwright {
namespace {

constexpr int kEnvironments = 64, kActs = 2000, kUpdates = 6;

// An environment without cost, so that the remaining time is the learner's.
class NoWorld : public rl::VectorEnvironment {
 public:
  NoWorld(int observations, int actions) : observations_(observations), actions_(actions) {}
  int size() const override { return kEnvironments; }
  int observation_size() const override { return observations_; }
  int action_size() const override { return actions_; }
  void Reset(std::uint64_t, rl::Rows* observations) override {
    *observations = rl::Rows::Random(kEnvironments, observations_);
  }
  void Step(const rl::Rows& actions, rl::StepBatch* batch) override {
    batch->observations = rl::Rows::Random(kEnvironments, observations_);
    batch->last_observations = batch->observations;
    batch->rewards.assign(kEnvironments, 0.0f);
    for (int i = 0; i < kEnvironments; ++i) {
      batch->rewards[static_cast<std::size_t>(i)] = -actions.row(i).squaredNorm();
    }
    batch->terminated.assign(kEnvironments, 0);
    batch->truncated.assign(kEnvironments, 0);
    batch->success.assign(kEnvironments, 0);
  }
  std::string SaveState() const override { return ""; }
  void RestoreState(std::string_view, rl::Rows* observations) override { Reset(0, observations); }

 private:
  int observations_, actions_;
};

template <typename Work>
double Seconds(int times, const Work& work) {
  work();
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < times; ++i) work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / times;
}

void Run(int observations, int actions) {
  const rl::PpoOptions options;
  NoWorld world(observations, actions);
  rl::Ppo ppo(&world, options);
  std::vector<rl::Outcome> outcomes;
  const double collect = Seconds(kUpdates, [&] { ppo.Collect(&outcomes); });
  const double update = Seconds(kUpdates, [&] { ppo.Update(); });
  const rl::Policy policy = ppo.CurrentPolicy();
  rl::Rows seen = rl::Rows::Random(kEnvironments, observations), acted;
  const double act = Seconds(kActs, [&] { policy.Act(seen, &acted); });
  const double samples = kEnvironments * options.horizon;
  const double worlds = samples / 4500.0;  // s, at 4500 steps/s
  std::printf("%d observations, %d actions, %d threads\n", observations, actions,
              core::ThreadCount());
  std::printf("act, batch of %d            %.0f us\n", kEnvironments, 1e6 * act);
  std::printf("collect, without a world    %.1f us per sample\n", 1e6 * collect / samples);
  std::printf("update                      %.0f samples/s (%d epochs: %.0f ms)\n",
              samples * options.epochs / update, options.epochs, 1e3 * update);
  std::printf("learner's share at 4500 environment steps/s  %.0f %%\n",
              100.0 * (update + collect) / (update + collect + worlds));
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  int observations = 40, actions = 8;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i];
    if (flag == "--threads") simwright::core::SetThreadCount(std::atoi(argv[i + 1]));
    if (flag == "--observations") observations = std::atoi(argv[i + 1]);
    if (flag == "--actions") actions = std::atoi(argv[i + 1]);
  }
  simwright::Run(observations, actions);
}
