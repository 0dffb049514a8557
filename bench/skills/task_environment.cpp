// Measures decisions per second of the environments of a task file in C++, for comparison with the
// same loop in Python (bench/python/environment_speed.py runs both).
//   bench_task_environment TASKS.json [--envs N] [--steps N] [--repeats N] [--threads N]
// Prints one number per repeat. Actions are a fixed function of step, environment and entry.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/parallel.h"
#include "skills/skill_environment.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_run.h"

namespace simwright {
namespace {

int Option(int count, char** arguments, const char* name, int otherwise) {
  for (int i = 1; i + 1 < count; ++i) {
    if (std::strcmp(arguments[i], name) == 0) return std::atoi(arguments[i + 1]);
  }
  return otherwise;
}

void SetActions(int step, rl::Rows* actions) {
  for (Eigen::Index i = 0; i < actions->rows(); ++i) {
    for (Eigen::Index a = 0; a < actions->cols(); ++a) {
      (*actions)(i, a) = 0.6f * std::sin(0.7f * static_cast<float>(step) + static_cast<float>(i) +
                                         2.0f * static_cast<float>(a));
    }
  }
}

int Run(int count, char** arguments) {
  core::SetThreadCount(Option(count, arguments, "--threads", 0));
  const int envs = Option(count, arguments, "--envs", 64);
  const int steps = Option(count, arguments, "--steps", 100);
  workflows::SkillRun run;
  run.set = tasks::ReadTaskFile(arguments[1]);
  skills::SkillEnvironment environment(workflows::PrepareSkills(run).front().evaluated, envs);
  for (int repeat = 0; repeat < Option(count, arguments, "--repeats", 3); ++repeat) {
    rl::Rows observations, actions(envs, environment.action_size());
    rl::StepBatch batch;
    environment.Reset(1, &observations);
    const auto start = std::chrono::steady_clock::now();
    for (int step = 0; step < steps; ++step) {
      SetActions(step, &actions);
      environment.Step(actions, &batch);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%.1f\n", envs * steps / seconds.count());
  }
  return 0;
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_task_environment TASKS.json [--envs N] ...\n");
    return 2;
  }
  return simwright::Run(argc, argv);
}
