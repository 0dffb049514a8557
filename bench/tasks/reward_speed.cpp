// Measures the speed of reward programs on one core.
//   bench_reward_speed [Google Benchmark's flags]
//   bench_reward_speed --python [PYTHON]   the same function in python3-torch beside ours
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <random>

#include "core/files.h"
#include "reward/reward_program.h"

namespace simwright::bench {
namespace {

std::string FilePath(const char* name) {
  return std::string(SIMWRIGHT_SOURCE_DIR) + "/" + name;
}

reward::RewardScene Scene() {
  reward::RewardAsset microwave;
  microwave.name = "microwave";
  microwave.links = {"link_0", "handle_0"};
  microwave.joints = {{"joint_0", reward::RewardJointType::kRevolute, 0.25, 1.5}};
  return {{microwave}};
}

// A program with random inputs, [num_envs, width] each.
struct Setup {
  Setup(const std::string& source, int num_envs)
      : scene(Scene()),
        outcome(reward::CompileReward(source, &scene)),
        workspace(*outcome.program, num_envs),
        reward(num_envs),
        success(num_envs) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (const reward::RewardSlot& slot : outcome.program->slots()) {
      inputs.emplace_back(static_cast<std::size_t>(num_envs) * slot.width);
      for (float& value : inputs.back()) value = uniform(generator);
    }
    for (const auto& input : inputs) bindings.push_back({input.data()});
  }
  void Run() {
    outcome.program->Run(bindings, static_cast<int>(reward.size()), &workspace, reward.data(),
                         success.data());
  }

  reward::RewardScene scene;
  reward::CompileOutcome outcome;
  reward::RewardWorkspace workspace;
  std::vector<std::vector<float>> inputs;
  std::vector<reward::RewardBinding> bindings;
  std::vector<float> reward;
  std::vector<std::uint8_t> success;
};

void DoorReward(benchmark::State& state) {
  Setup setup(core::ReadFile(FilePath("bench/tasks/door_reward.py")),
              static_cast<int>(state.range(0)));
  for (auto _ : state) {
    setup.Run();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["operations"] = setup.outcome.program->operations();
}
BENCHMARK(DoorReward)->Arg(256)->Arg(4096)->Unit(benchmark::kMicrosecond);

void CompileDoorReward(benchmark::State& state) {
  const std::string source = core::ReadFile(FilePath("bench/tasks/door_reward.py"));
  const reward::RewardScene scene = Scene();
  for (auto _ : state) benchmark::DoNotOptimize(reward::CompileReward(source, &scene));
}
BENCHMARK(CompileDoorReward)->Unit(benchmark::kMicrosecond);

// Compiles the longest of the tests' programs, with the shapes of its parameters inferred.
void CompileLongReward(benchmark::State& state, const char* name) {
  const std::string source = core::ReadFile(FilePath("tests/reward/corpus/") + name);
  for (auto _ : state) benchmark::DoNotOptimize(reward::CompileReward(source, nullptr));
}
BENCHMARK_CAPTURE(CompileLongReward, shapes, "shapes.py")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(CompileLongReward, numbers, "numbers.py")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(CompileLongReward, hand, "hand_spin_v5.py")->Unit(benchmark::kMicrosecond);

// Returns processor time, like time_python.py: other programs on the core do not count.
double MedianMicroseconds(Setup* setup) {
  std::vector<double> runs;
  constexpr int kCalls = 200;
  for (int run = 0; run < 60; ++run) {
    const std::clock_t start = std::clock();
    for (int call = 0; call < kCalls; ++call) setup->Run();
    runs.push_back(1e6 / CLOCKS_PER_SEC * static_cast<double>(std::clock() - start) / kCalls);
  }
  std::nth_element(runs.begin(), runs.begin() + runs.size() / 2, runs.end());
  return runs[runs.size() / 2];
}

double PythonMicroseconds(const std::string& python, int num_envs) {
  const std::string command = python + " '" + FilePath("bench/tasks/time_python.py") + "' '" +
                              FilePath("bench/tasks/door_reward.py") + "' " +
                              std::to_string(num_envs);
  FILE* pipe = popen(command.c_str(), "r");
  double microseconds = 0.0;
  if (pipe == nullptr || std::fscanf(pipe, "%lf", &microseconds) != 1) {
    std::fprintf(stderr, "error: %s does not run (install python3-torch)\n", command.c_str());
  }
  if (pipe != nullptr) pclose(pipe);
  return microseconds;
}

int ComparePython(const std::string& python) {
  std::printf(
      "| environments | ours, us | python3-torch, 1 thread, us | ratio |\n|---|---|---|---|\n");
  for (const int num_envs : {256, 4096}) {
    Setup setup(core::ReadFile(FilePath("bench/tasks/door_reward.py")), num_envs);
    const double ours = MedianMicroseconds(&setup);
    const double theirs = PythonMicroseconds(python, num_envs);
    if (theirs == 0.0) return 1;
    std::printf("| %d | %.2f | %.1f | %.1f |\n", num_envs, ours, theirs, theirs / ours);
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--python") == 0) {
    return simwright::bench::ComparePython(argc > 2 ? argv[2] : "/usr/bin/python3");
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
