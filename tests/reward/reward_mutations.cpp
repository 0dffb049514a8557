#include "tests/reward/reward_mutations.h"

#include <regex>

namespace simwright::reward {
namespace {

// Replaces the first match of `pattern` in a program.
struct Edit {
  const char* kind;
  const char* pattern;
  const char* with;
};

constexpr Edit kFaults[] = {
    {"sign of the way to the thing", " - reach", " + reach"},
    {"sign of the way to the thing", " - 0\\.5 \\* reach", " + 0.5 * reach"},
    {"sign of the progress", "reward = 2\\.0 \\*", "reward = -2.0 *"},
    {"sign of the progress", "reward = -2\\.0 \\* torch\\.clamp", "reward = 2.0 * torch.clamp"},
    {"sign of the progress", "- 2\\.0 \\* distance", "+ 2.0 * distance"},
    {"sign of the progress", "reward = -2\\.0 \\* distance", "reward = 2.0 * distance"},
    {"sign of the progress", "- 2\\.0 \\* missing", "+ 2.0 * missing"},
    {"sign of the whole reward", "reward = (.*)", "reward = -($1)"},
    {"unknown link", "(get_pose_by_link_name\\(\"[^\"]*\", \"[^\"]*)\"", "$1_x\""},
    {"unknown link", "(get_bounding_box_link\\(\"[^\"]*\", \"[^\"]*)\"", "$1s\""},
    {"unknown joint", "(get_state_by_joint_name\\(\"[^\"]*\", \")", "$1the_"},
    {"unknown asset", "(get_position\\(\"[^\"]*)\"", "$1_9\""},
    {"undefined name", "reach = torch", "reaching = torch"},
    {"undefined name", "distance = torch", "dist = torch"},
    {"undefined function", "get_robot_gripper_pose", "get_robot_hand_location"},
    {"distance of a thing to itself", "torch\\.norm\\(gripper - \\w+",
     "torch.norm(gripper - gripper"},
    {"distance of a thing to itself", "torch\\.norm\\(env\\.get_goal_pose\\(\\) - thing",
     "torch.norm(thing - thing"},
    {"distance of a thing to itself", "torch\\.norm\\(top - foot", "torch.norm(foot - foot"},
    {"constant success", "success = .*", "success = reward == reward"},
    {"constant success", "success = .*", "success = torch.ones(env.num_envs) > 0"},
    {"constant reward", "reward = (.*)", "reward = 0.0 * ($1)"},
    {"constant reward", "reward = .*", "reward = torch.zeros(env.num_envs)"},
    {"success outside the limits", "moved >= 0\\.7", "moved >= 1.15"},
    {"success outside the limits", "moved <= 0\\.05", "moved <= -0.15"},
    {"success that never holds", "(distance|missing) <= 0\\.03", "$1 <= -0.03"},
    {"success at the start", "moved >= 0\\.7", "moved >= -0.1"},
    {"success at the start", "moved <= 0\\.05", "moved <= 1.1"},
    {"success at the start", "success = distance <= 0\\.03", "success = distance <= 3.0"},
    {"success at the start", "success = (.*)", "success = torch.logical_not($1)"},
    {"target out of reach", "env\\.get_goal_pose\\(\\) - thing",
     "env.get_goal_pose() + 2.0 - thing"},
    {"one-armed logical_and", "torch\\.logical_and\\(([^,()]*), .*", "torch.logical_and($1)"},
    {"norm over all environments", ", dim=-1\\)", ")"},
    {"shape", "reach = torch\\.norm\\((.*), dim=-1\\)", "reach = torch.abs($1)"},
    {"shape", "distance = torch\\.norm\\((.*), dim=-1\\)", "distance = torch.abs($1)"},
    {"column that is not there", "thing\\[:, :2\\]", "thing[:, 5]"},
    {"no success", "return reward, success", "return reward"},
    {"no return", "    return reward, success\n", ""},
    {"three values", "return reward, success", "return reward, success, 0.0"},
    {"missing bracket", "dim=-1\\)", "dim=-1"},
};

constexpr Edit kRewrites[] = {
    {"squashed", "    return", "    reward = torch.tanh(reward)\n    return"},
    {"exponential", "    return", "    reward = torch.exp(0.5 * reward)\n    return"},
    {"shifted", "    return", "    reward = reward + 10.0\n    return"},
    {"scaled", "    return", "    reward = 0.01 * reward\n    return"},
    {"bonus", "    return", "    reward = reward + 5.0 * success.float()\n    return"},
    {"penalty of time", "    return", "    reward = reward - 0.01\n    return"},
    {"self for env",
     "def compute_reward\\(env\\):", "def compute_reward(self):\n    env = self.env"},
    {"other name", "get_robot_gripper_pose", "get_robot_gripper_position"},
    {"other name", "get_pose_by_link_name", "get_position_by_asset_link_name"},
    {"numpy", "torch\\.norm\\((.*), dim=-1\\)", "np.linalg.norm($1, axis=-1)"},
    {"method", "torch\\.norm\\((.*), dim=-1\\)", "($1).norm(dim=-1)"},
    {"root of squares", "torch\\.norm\\((.*), dim=-1\\)", "torch.sqrt((($1) ** 2).sum(dim=-1))"},
    {"components", "return reward, success",
     "parts = {\"reward\": reward}\n    return parts[\"reward\"], success"},
    {"copied", "return reward, success", "return reward.clone(), success"},
    {"typed", "def compute_reward\\(env\\):", "import torch\n\ndef compute_reward(env) -> tuple:"},
};

void Apply(const Edit& edit, const tasks::Subtask& subtask, std::vector<Mutant>* mutants) {
  Mutant mutant{edit.kind, subtask};
  mutant.subtask.program = std::regex_replace(subtask.program, std::regex(edit.pattern), edit.with,
                                              std::regex_constants::format_first_only);
  mutant.subtask.findings.clear();
  if (mutant.subtask.program != subtask.program) mutants->push_back(std::move(mutant));
}

}  // namespace

std::vector<Mutant> PlantFaults(const tasks::Subtask& subtask, const std::string& other_way) {
  std::vector<Mutant> mutants;
  for (const Edit& edit : kFaults) Apply(edit, subtask, &mutants);
  if (!other_way.empty()) {
    Mutant mutant{"program against the title", subtask};
    mutant.subtask.program = other_way;
    mutants.push_back(mutant);
    // The same mutant on a start that suits the program.
    mutant.subtask.start = tasks::InitialState{};
    mutants.push_back(std::move(mutant));
  }
  return mutants;
}

std::vector<Mutant> RewriteSoundly(const tasks::Subtask& subtask) {
  std::vector<Mutant> mutants;
  for (const Edit& edit : kRewrites) Apply(edit, subtask, &mutants);
  return mutants;
}

}  // namespace simwright::reward
