// Trains PPO on Gymnasium's Reacher-v5 and Pusher-v5, from their own model files, and prints the
// mean return of 50 played episodes as the samples grow.
//   bench_known_tasks --help
// bench/peers/known_tasks.py runs it beside Stable-Baselines3 on the same tasks.
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "bench/rl/mujoco_task.h"
#include "core/parallel.h"
#include "rl/ppo.h"

namespace simwright {
namespace {

constexpr int kPlayed = 50, kEnvironments = 16;

struct Settings {
  std::string task = "reacher", model;
  int seeds = 3;
  std::uint64_t first_seed = 1;
  std::int64_t samples = 300'000, play_every = 20'480;
  rl::PpoOptions ppo;
};

Settings DefaultSettings() {
  Settings settings;
  settings.ppo.horizon = 128;
  settings.ppo.minibatch = 512;
  settings.ppo.hidden = {64, 64};
  // The values of bench_inverted_pendulum.
  settings.ppo.initial_std = 0.35;
  settings.ppo.target_kl = 0.02;
  return settings;
}

void AddOptions(CLI::App* app, Settings* settings) {
  const auto add = [app](const char* name, auto* value, const char* help) {
    return app->add_option(name, *value, help)->capture_default_str();
  };
  add("--task", &settings->task, "reacher or pusher")->check(CLI::IsMember({"reacher", "pusher"}));
  add("--model", &settings->model, "Gymnasium's reacher.xml or pusher_v5.xml")->required();
  add("--seeds", &settings->seeds, "Number of trainings");
  add("--first-seed", &settings->first_seed, "Seed of the first one");
  add("--samples", &settings->samples, "Of each training");
  add("--play-every", &settings->play_every, "Samples between evaluations");
  add("--horizon", &settings->ppo.horizon, "Steps of an environment between updates");
  add("--minibatch", &settings->ppo.minibatch, "Samples per gradient step");
  add("--epochs", &settings->ppo.epochs, "Passes over each sample");
  add("--initial-std", &settings->ppo.initial_std, "Of the actions, at the start");
  add("--target-kl", &settings->ppo.target_kl, "KL divergence of an update that keeps the rate");
  add("--learning-rate", &settings->ppo.learning_rate, "At the start");
  add("--discount", &settings->ppo.discount, "Of later rewards, per step");
  app->add_option_function<int>("--threads", core::SetThreadCount, "Number of threads");
}

rl::KnownTask TaskOf(const std::string& name) {
  return name == "reacher" ? rl::KnownTask::kReacher : rl::KnownTask::kPusher;
}

// Returns the mean return of the policy's mean action over kPlayed episodes.
double Play(const Settings& settings, const rl::Policy& policy) {
  rl::MujocoTask environment(TaskOf(settings.task), settings.model, kPlayed);
  rl::Rows observations, actions;
  environment.Reset(12345, &observations);
  rl::StepBatch batch;
  double sum = 0.0;
  for (int step = 0; step < environment.steps(); ++step) {
    policy.Act(observations, &actions);
    environment.Step(actions, &batch);
    for (const float reward : batch.rewards) sum += static_cast<double>(reward);
    observations = batch.observations;
  }
  return sum / kPlayed;
}

void Train(const Settings& settings, std::uint64_t seed) {
  rl::MujocoTask environment(TaskOf(settings.task), settings.model, kEnvironments);
  rl::PpoOptions options = settings.ppo;
  options.seed = seed;
  rl::Ppo ppo(&environment, options);
  for (std::int64_t next = settings.play_every; ppo.samples() < settings.samples;) {
    std::vector<rl::Outcome> outcomes;
    ppo.Collect(&outcomes);
    ppo.Update();
    if (ppo.samples() < next) continue;
    next += settings.play_every;
    std::printf("%s %llu %lld %.2f\n", settings.task.c_str(), static_cast<unsigned long long>(seed),
                static_cast<long long>(ppo.samples()), Play(settings, ppo.CurrentPolicy()));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Mean returns of PPO on known tasks: task, seed, samples, mean return");
  simwright::Settings settings = simwright::DefaultSettings();
  simwright::AddOptions(&app, &settings);
  CLI11_PARSE(app, argc, argv);
  try {
    for (int i = 0; i < settings.seeds; ++i) {
      simwright::Train(settings, settings.first_seed + static_cast<std::uint64_t>(i));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
