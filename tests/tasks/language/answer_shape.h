#pragma once

#include <string>

#include "reward/reward_program.h"
#include "tasks/language/task_answer.h"

namespace simwright::tasks {

// Returns a reward function of `joint`, by which it is distinguished from others.
inline std::string Function(const std::string& joint, const std::string& name = "compute_reward",
                            const std::string& indent = "") {
  const std::string lines[] = {
      "def " + name + "(env):",
      "    # how far it has come",
      "    state = env.get_state_by_joint_name(\"oven\", \"" + joint + "\")",
      "",
      "    reward = state - torch.norm(",
      "        env.get_robot_gripper_pose(), dim=-1",
      "    )",
      "    success = state > 0.5",
      "    return reward, success"};
  std::string text;
  for (const std::string& line : lines) text += (line.empty() ? "" : indent + line) + "\n";
  return text;
}

inline std::string Fenced(const std::string& code, const std::string& language = "python") {
  return "```" + language + "\n" + code + "```\n";
}

// Returns "task(subtask:joint subtask:joint) task(...)"; a program that does not compile has the
// joint '!', a missing one '-'.
inline std::string Shape(const TaskAnswer& answer) {
  std::string shape;
  for (const Task& task : answer.tasks) {
    shape += (shape.empty() ? "" : " ") + task.name + "(";
    for (const Subtask& subtask : task.subtasks) {
      std::string joint = "-";
      if (!subtask.program.empty()) {
        const reward::CompileOutcome outcome = reward::CompileReward(subtask.program, nullptr);
        joint = "!";
        if (outcome.program) {
          for (const reward::RewardSlot& slot : outcome.program->slots()) {
            if (slot.input == reward::RewardInput::kJointState) joint = slot.part;
          }
        }
      }
      shape += (shape.ends_with('(') ? "" : " ") + subtask.name + ":" + joint;
    }
    shape += ")";
  }
  return shape;
}

inline std::string ShapeOf(const std::string& text) {
  return Shape(ReadTaskAnswer(text));
}

}  // namespace simwright::tasks
