// Compiles a reward function, prints what the checks find in a wrong one, and runs the right one.
#include <cstdio>
#include <vector>

#include <simwright/reward/reward_program.h>

namespace reward = simwright::reward;

int main() {
  const char* source =
      "def compute_reward(env):\n"
      "    cup = env.get_position('cup')\n"
      "    distance = torch.norm(env.get_goal_pose() - cup, dim=-1)\n"
      "    return -distance, distance < 0.05\n";
  const reward::RewardScene scene{{{"cup", {"base"}, {}}}};
  const std::string wrong = "def compute_reward(env):\n    return env.get_position('cub')[:, 2]\n";
  for (const auto& finding : reward::CompileReward(wrong, &scene).findings) {
    std::printf("%s\n", reward::RenderFinding(finding, wrong).c_str());
  }
  const reward::CompileOutcome outcome = reward::CompileReward(source, &scene);
  if (!outcome.program) return 1;
  // Two environments: the cup 0.3 m from the goal, and at the goal.
  const float at[6] = {0.0f, 0.0f, 0.3f, 0.0f, 0.0f, 0.0f}, goal[6] = {};
  std::vector<reward::RewardBinding> bindings;
  for (const reward::RewardSlot& slot : outcome.program->slots()) {
    bindings.push_back({slot.input == reward::RewardInput::kGoalPosition ? goal : at});
  }
  reward::RewardWorkspace workspace(*outcome.program, 2);
  float rewards[2];
  std::uint8_t success[2];
  outcome.program->Run(bindings, 2, &workspace, rewards, success);
  std::printf("rewards %.3f %.3f, success %d %d\n", rewards[0], rewards[1], success[0], success[1]);
  return rewards[0] < -0.299f && rewards[1] == 0.0f && !success[0] && success[1] ? 0 : 1;
}
