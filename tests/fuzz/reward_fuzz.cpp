// Reward programs from anywhere: findings, or a program that runs.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "reward/reward_program.h"

namespace {

using namespace simwright::reward;

void RunOnFew(const RewardProgram& program) {
  constexpr int kEnvironments = 3;
  std::vector<std::vector<float>> inputs;
  std::vector<RewardBinding> bindings;
  for (const RewardSlot& slot : program.slots()) {
    inputs.emplace_back(static_cast<std::size_t>(kEnvironments) * slot.width, 0.5f);
  }
  for (const auto& input : inputs) bindings.push_back({input.data()});
  RewardWorkspace workspace(program, kEnvironments);
  float reward[kEnvironments];
  std::uint8_t success[kEnvironments];
  std::vector<std::vector<float>> components;
  for (const RewardComponent& component : program.components()) {
    components.emplace_back(static_cast<std::size_t>(kEnvironments) * component.width);
  }
  std::vector<float*> outputs;
  for (auto& component : components) outputs.push_back(component.data());
  try {
    program.Run(bindings, kEnvironments, &workspace, reward, success, outputs);
  } catch (const simwright::core::Error&) {  // an environment that is not there
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view source(reinterpret_cast<const char*>(data), size);
  RewardScene scene;
  scene.assets.push_back(
      {"microwave", {"link_0", "handle_0"}, {{"joint_0", RewardJointType::kRevolute, 0.25, 1.5}}});
  scene.assets.push_back({"cup", {"base"}, {}});
  RewardOptions options;
  options.max_steps = 5000;
  options.max_nodes = 20000;
  const CompileOutcome outcome = CompileReward(source, size % 2 == 0 ? &scene : nullptr, options);
  if (!outcome.program.has_value() && outcome.findings.empty()) std::abort();
  for (const simwright::core::Finding& finding : outcome.findings) {
    if (RenderFinding(finding, source).empty() || finding.sentence.empty()) std::abort();
  }
  if (outcome.program.has_value()) RunOnFew(*outcome.program);
  return 0;
}
